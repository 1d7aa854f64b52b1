// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/detector_option.hpp"
#include "bench/cli/progress.hpp"
#include "bench/inputs/recorded_camera.hpp"
#include "bench/studies/draw_detections.hpp"
#include "bench/world/cached_detections.hpp"
#include "scenes/image_file.hpp"
#include "scenes/images/write_image.hpp"
#include "scenes/recorded/frame_sequence.hpp"
#include "scenes/recorded/open_sequence.hpp"
#include "slam/core/counted.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"

namespace mh::cli {
namespace {

namespace fs = std::filesystem;

struct DetectorArguments {
  std::vector<std::string> sources;
  std::string settings, out;
  DetectorOption detector;
  std::size_t frames = SIZE_MAX, every = 1;
  bool labels = false;
};

bool is_image(const fs::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".png" || ending == ".jpg" || ending == ".jpeg";
}

/// Image files as they are, or the frames of one recording.
class Frames {
 public:
  Frames(const DetectorArguments& options) {
    if (std::ranges::all_of(options.sources, is_image)) {
      images_ = options.sources;
      return;
    }
    if (options.sources.size() != 1)
      throw InputError("several sources: they must all be images (.png, .jpg), or one a recording");
    Settings read;
    OpenedRecording opened =
        open_sequence(options.sources.front(), {.calibration = options.settings,
                                                .classes = {},
                                                .labels = false,
                                                .read_camera = camera_reader(&read)});
    sequence_ = std::move(opened.sequence);
  }
  std::size_t size() const { return sequence_ ? sequence_->size() : images_.size(); }
  /// Images in files have that of an RgbdFrame without one.
  std::vector<Stamp> stamps_ns() const {
    return sequence_ ? stamps_of(*sequence_)
                     : std::vector<Stamp>(images_.size(), RgbdFrame{}.stamp_ns);
  }
  RgbdFrame frame(std::size_t i) const {
    if (sequence_) return sequence_->frame(i, RandomStream());
    RgbdFrame frame;
    frame.color = color_of(read_image(images_[i], ImageForm::kColor));
    return frame;
  }

 private:
  std::unique_ptr<Sequence> sequence_;
  std::vector<std::string> images_;
};

/// COCO's results of a frame. The category is the class's index, from 1, as own class names count;
/// of COCO's 80 classes it is COCO's id.
void add_results(nlohmann::ordered_json& json, std::size_t frame, const Detected& found,
                 bool of_coco) {
  std::map<int, int> category;  // by index among the 80
  for (int id = 1; id <= 90; ++id) category[coco80_of_category(id)] = id;
  for (const DetectedBox& box : found.boxes)
    json.push_back({{"image_id", frame},
                    {"category_id", of_coco ? category[box.network_class] : box.network_class + 1},
                    {"bbox", {box.left, box.top, box.right - box.left, box.bottom - box.top}},
                    {"score", box.score}});
}

constexpr const char* kResults = "detections.json";

std::string image_name(std::size_t frame) {
  return fmt::format("{:06}.png", frame);
}

/// An image beside the drawings could be taken for one of them.
void require_sources_elsewhere(const DetectorArguments& options) {
  std::error_code error;
  for (const std::string& source : options.sources) {
    const fs::path folder =
        fs::path(source).has_parent_path() ? fs::path(source).parent_path() : ".";
    if (is_image(source) && fs::equivalent(folder, options.out, error) && !error)
      throw InputError(
          fmt::format("{}: lies in the folder to write, {}: name another", source, options.out));
  }
}

/// Removes what an earlier run of this command wrote, so that nothing of it stands beside the new.
void remove_earlier(const fs::path& out) {
  std::error_code error;
  fs::remove(out / kResults, error);
  for (const std::string& name : list_folder(out, "[0-9][0-9][0-9][0-9][0-9][0-9].png"))
    fs::remove(out / name, error);
}

void run(DetectorArguments options) {
  resolve(options.settings, Shipped::kSettings);
  const auto spec = options.detector.spec();
  if (!spec) throw InputError("no detector is named: --network does");
  const Frames frames(options);
  const std::unique_ptr<Detector> detector = open_detector(*spec);
  const std::string unmatched = detector->check_frames(frames.stamps_ns());
  const fs::path out = options.out;
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i < std::min(frames.size(), options.frames); i += options.every)
    wanted.push_back(i);
  require_sources_elsewhere(options);
  std::vector<std::string> names = {kResults};
  for (const std::size_t i : wanted) names.push_back(image_name(i));
  const OutputFolder folder(out, "detector run", std::move(names));
  if (folder.was_ours()) remove_earlier(out);
  Progress progress("detector run");
  const KeepDetections in_cache = detections_in(options.detector.opened_cache("detector run"));
  bool made = false;  // by the network, not taken from the cache
  KeepDetections keep;
  if (in_cache != nullptr && detector->digest() != 0)
    keep = [&](const std::string& key, const auto& make) {
      return in_cache(key, [&] {
        made = true;
        return make();
      });
    };
  if (!unmatched.empty()) progress.say("warning: " + unmatched);
  std::map<std::string, std::size_t> count;
  std::vector<double> ms;
  auto results = nlohmann::ordered_json::array();
  std::size_t images = 0, boxes = 0, clipped = 0, skipped = 0;
  for (const std::size_t i : wanted) {
    RgbdFrame frame;
    try {
      frame = frames.frame(i);
    } catch (const InputError& error) {
      if (skipped++ == 0)
        progress.say(fmt::format("warning: frame {} is skipped: {}", i, error.what()));
      continue;
    }
    const auto start = std::chrono::steady_clock::now();
    made = keep == nullptr;
    const Detected found = detect_kept(*detector, frame, i, keep);
    ++images;
    if (made)
      ms.push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
              .count());
    boxes += found.boxes.size();
    clipped += static_cast<std::size_t>(found.clipped);
    for (const DetectedBox& box : found.boxes)
      ++count[detector->names().names[static_cast<std::size_t>(box.network_class)]];
    add_results(results, i, found, spec->classes.empty());
    SemanticImage labels;
    if (options.labels || !found.pixels.index.empty())
      labels = labels_of(found, frame.depth_m, frame.color.width(), frame.color.height(),
                         spec->settings.fill);
    write_image(out / image_name(i),
                draw_detections(frame.color, found.boxes, detector->names(), labels));
    progress.share(static_cast<double>(i + 1) / static_cast<double>(wanted.back() + 1));
  }
  progress.end();
  if (images == 0)
    throw InputError(fmt::format("{}: no frame can be read", options.sources.front()));
  write_atomically(out / kResults, results.dump(1) + "\n");
  std::ranges::sort(ms);
  fmt::print("{}\n{}, {}", detector->description(), counted(images, "image"),
             counted(boxes, "box", "boxes"));
  if (!ms.empty()) fmt::print(", {:.1f} ms an image (median, on the clock)", ms[ms.size() / 2]);
  if (ms.size() < images) fmt::print(", {} from the cache", images - ms.size());
  fmt::print("\n");
  if (clipped > 0) fmt::print("{} reached beyond the image\n", counted(clipped, "box", "boxes"));
  if (skipped > 0) fmt::print("{} could not be read\n", counted(skipped, "frame"));
  std::vector<std::pair<std::string, std::size_t>> most(count.begin(), count.end());
  std::ranges::stable_sort(most, [](const auto& a, const auto& b) { return a.second > b.second; });
  for (const auto& [name, n] : most) fmt::print("{:>7}  {}\n", n, name);
}

}  // namespace

void add_detector(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "detector",
      "Runs a real object detector, and judges it by the exact truth of rendered rooms.");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n  modelhouse detector run out/sequence --network yolox_nano.onnx --out "
      "out/boxes\n"
      "  modelhouse detector score --network yolox_nano.onnx --out out/score");

  auto options = std::make_shared<DetectorArguments>();
  CLI::App* r = command->add_subcommand("run", "Draws what it finds in a recording or in images.");
  r->add_option("sources", options->sources, "Images (.png, .jpg), or one recording")->required();
  options->detector.add_to(*r, "--network,--detector");
  r->add_option("--settings", options->settings,
                "Calibration of the recording (YAML), or the name of a shipped one");
  r->add_option("--out", options->out, "Folder for images and detections.json (COCO's results)")
      ->required();
  r->add_flag("--labels", options->labels, "Draws the labels of the pixels beside each frame");
  r->add_option("--frames", options->frames, "Only the first so many frames")
      ->default_str("all")
      ->check(CLI::Range(1, 100000000));
  r->add_option("--every", options->every, "Every n-th frame only")
      ->check(CLI::Range(1, 100000000));
  r->add_flag_callback(
      "--print-settings",
      [] {
        fmt::print("{}", format_detector_settings({}, true));
        throw CLI::Success();
      },
      "Prints every setting with its default, meaning and range");
  r->footer(
      "Example:\n  modelhouse detector run tum:../data/tum_fr1_rpy --settings tum_freiburg1 "
      "--network yolox_nano.onnx --out out/boxes");
  r->callback([options] { run(*options); });
  add_detector_score(*command);
}

}  // namespace mh::cli
