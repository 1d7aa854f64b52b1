// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/detector_option.hpp"
#include "bench/cli/progress.hpp"
#include "bench/lab/draw_detections.hpp"
#include "bench/protocol/world/cached_detections.hpp"
#include "bench/suite/recorded_camera.hpp"
#include "scenes/image_file.hpp"
#include "scenes/recordings/frame_sequence.hpp"
#include "scenes/recordings/images/write_image.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/files.hpp"
#include "slam/io/printable.hpp"
#include "slam/io/temporary_folder.hpp"
#include "slam/io/text_file.hpp"

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
      if (!options.settings.empty())
        throw InputError(fmt::format(
            "--settings {}: is for a recording, and the sources are images", options.settings));
      images_ = options.sources;
      for (const std::string& image : images_)
        if (!is_there(image)) read_file(image);  // throws; damaged images are skipped later
      return;
    }
    if (options.sources.size() != 1)
      throw InputError(
          "several sources: they must all be images (.png, .jpg), or a single recording");
    Settings read;
    OpenedRecording opened =
        open_sequence(options.sources.front(), {.calibration = options.settings,
                                                .classes = {},
                                                .labels = false,
                                                .read_camera = camera_reader(&read)});
    sequence_ = std::move(opened.sequence);
  }
  std::size_t size() const { return sequence_ ? sequence_->size() : images_.size(); }
  /// For image files, each stamp is the default stamp of an RgbdFrame.
  std::vector<Stamp> stamps_ns() const {
    return sequence_ ? stamps_of(*sequence_)
                     : std::vector<Stamp>(images_.size(), RgbdFrame{}.stamp_ns);
  }
  /// " of FILE" for an image file; empty for a recording's frame.
  std::string source_of(std::size_t i) const {
    return sequence_ ? "" : " of " + printable(images_[i]);
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

/// Appends a frame's results in COCO's format. For COCO's 80 classes, `category_id` is COCO's own
/// id; for other classes, it is the index of the class, starting from 1.
void add_results(nlohmann::ordered_json& json, std::size_t frame, const Detected& found,
                 bool of_coco) {
  std::map<int, int> category;  // COCO's ids by index among the 80
  for (int id = 1; id <= 90; ++id) category[coco80_of_category(id)] = id;
  for (const DetectedBox& box : found.boxes)
    json.push_back({{"image_id", frame},
                    {"category_id", of_coco ? category[box.network_class] : box.network_class + 1},
                    {"bbox", {box.left, box.top, box.right - box.left, box.bottom - box.top}},
                    {"score", box.score}});
}

constexpr const char* kResults = "detections.json";

constexpr const char* kDrawn = "drawn.txt";

std::string image_name(std::size_t frame) {
  return fmt::format("{:06}.png", frame);
}
bool is_image_name(const std::string& name) {
  return name.size() >= 10 && name.ends_with(".png") &&
         std::ranges::all_of(name.substr(0, name.size() - 4),
                             [](char c) { return c >= '0' && c <= '9'; });
}

/// @throws InputError if an input file is in the output folder, where it could be mistaken for
/// output.
void require_read_elsewhere(const DetectorArguments& options, const DetectorSpec& spec) {
  std::vector<fs::path> read = {spec.boxes};
  for (const std::string& source : options.sources)
    if (is_image(source)) read.emplace_back(source);
  std::error_code error;
  for (const fs::path& file : read) {
    if (file.empty()) continue;
    const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
    for (const fs::path& place : {folder, file})  // the boxes may be a folder
      if (fs::equivalent(place, options.out, error) && !error)
        throw InputError(fmt::format("{}: is in the output folder, {}: name another", file.string(),
                                     options.out));
  }
}

/// The images that an earlier run of this command drew, according to its own list.
std::vector<std::string> drawn_earlier(const fs::path& out) {
  std::vector<std::string> names;
  if (!is_file(out / kDrawn)) return names;
  std::istringstream lines(read_text(out / kDrawn));
  for (std::string line; std::getline(lines, line);)
    if (const std::string name = line.substr(0, line.find(' ')); is_image_name(name))
      names.push_back(name);
  return names;
}

/// @throws InputError naming the file if an image to be written has the name of an existing file
/// that is not from an earlier run.
void require_no_other_images(const fs::path& out, const std::vector<std::size_t>& wanted) {
  const std::vector<std::string> earlier = drawn_earlier(out);
  for (const std::size_t i : wanted)
    if (const std::string name = image_name(i);
        is_there(out / name) && std::ranges::count(earlier, name) == 0)
      throw InputError(
          fmt::format("{}: already exists and was not written by `modelhouse detector run`: name "
                      "another folder",
                      (out / name).string()));
}

/// Replaces an earlier result with a finished one.
void replace_earlier(const fs::path& work, const fs::path& out, const std::string& results,
                     const std::string& drawn) {
  std::error_code error;
  for (const std::string& name : drawn_earlier(out)) fs::remove(out / name, error);
  for (const std::string& name : list_folder(work, "*.png")) {
    fs::rename(work / name, out / name, error);
    if (error) throw_unwritable(out / name, error.value());
  }
  write_atomically(out / kDrawn, drawn);
  write_atomically(out / kResults, results);
}

void run(DetectorArguments options) {
  resolve(options.settings, Shipped::kSettings);
  const auto spec = options.detector.spec();
  if (!spec) throw InputError("no detector is given: name one with --network");
  const ReadScope reading;
  const Frames frames(options);
  const std::unique_ptr<Detector> detector = open_detector(*spec);
  const std::string unmatched = detector->check_frames(frames.stamps_ns());
  const fs::path out = options.out;
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i < std::min(frames.size(), options.frames); i += options.every)
    wanted.push_back(i);
  require_read_elsewhere(options, *spec);
  require_no_other_images(out, wanted);
  const OutputFolder folder(out, "detector run", {kResults, kDrawn});
  const TemporaryFolder work(out);  // keeps an earlier result until this one is complete
  Progress progress("detector run");
  const KeepDetections in_cache = detections_in(options.detector.opened_cache("detector run"));
  bool made = false;  // whether the network made the boxes
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
  std::string drawn;
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
    drawn += fmt::format("{} {}{}\n", image_name(i), counted(found.boxes.size(), "box", "boxes"),
                         frames.source_of(i));
    write_image(work.path() / image_name(i),
                draw_detections(frame.color, found.boxes, detector->names(), labels));
    progress.share(static_cast<double>(i + 1) / static_cast<double>(wanted.back() + 1));
  }
  progress.end();
  if (images == 0)
    throw InputError(fmt::format("{}: no frame can be read", options.sources.front()));
  require_unchanged(reading.record());
  replace_earlier(work.path(), out, results.dump(1) + "\n", drawn);
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
      "Runs a real object detector, and scores it against the exact truth of rendered rooms.");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n  modelhouse detector run out/sequence --network yolox_nano.onnx --out "
      "out/boxes\n"
      "  modelhouse detector score --network yolox_nano.onnx --out out/score");

  auto options = std::make_shared<DetectorArguments>();
  CLI::App* r =
      command->add_subcommand("run", "Draws what the detector finds in a recording or in images.");
  r->add_option("sources", options->sources, "Images (.png, .jpg), or one recording")->required();
  options->detector.add_to(*r, "--network,--detector");
  r->add_option("--settings", options->settings,
                "Calibration of the recording (YAML), or the name of a shipped one");
  r->add_option(
       "--out", options->out,
       "Folder for images, their list drawn.txt, and detections.json (COCO's results format)")
      ->required();
  r->add_flag("--labels", options->labels, "Draws the labels of the pixels next to each frame");
  r->add_option("--frames", options->frames, "At most this many frames, from the first on")
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
