// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/detector_option.hpp"
#include "bench/cli/progress.hpp"
#include "bench/cli/usual_cache.hpp"
#include "bench/lab/detector_score.hpp"
#include "bench/lab/draw_detections.hpp"
#include "bench/lab/survey.hpp"
#include "bench/protocol/world/cached_detections.hpp"
#include "bench/protocol/world/cached_light.hpp"
#include "scenes/load.hpp"
#include "scenes/recordings/images/write_image.hpp"
#include "sim/sensors/config.hpp"
#include "sim/simulation/lit_scene.hpp"
#include "sim/simulation/simulated_sequence.hpp"
#include "sim/simulation/travel.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh::cli {
namespace {

/// A sensor level may replace a sensor level, but no other file. @throws InputError naming it.
void require_no_other_than_level(const std::filesystem::path& file) {
  if (!is_file(file)) return;
  try {
    load_sensor_config(file);
  } catch (const InputError&) {
    throw InputError(
        fmt::format("{}: is not a sensor level: name another file to write", file.string()));
  }
}

namespace fs = std::filesystem;

struct DetectorScoreArguments {
  DetectorOption detector;
  std::vector<std::string> scenes;
  std::string level = "handheld", robot = "pepper", out, base = "pepper";
  int per_category = 2, threads = 2;
  std::size_t frames = 10;
  bool json = false;
};

/// COCO's evaluation uses boxes with scores down to this value; the threshold of a detector is far
/// higher.
constexpr double kLeastScore = 0.01;

std::vector<std::string> names_of(const DetectorScoreArguments& options) {
  return options.scenes.empty() ? generated_rooms(options.per_category) : options.scenes;
}

/// One judged frame, with the objects that were missed and the boxes that were found.
struct JudgedFrame {
  Grid2d<Rgb8> color;
  std::vector<VisibleObject> missed;
  std::vector<DetectedBox> found;
  double missed_pixels = 0;
};

/// The frames in which a detector missed the most object pixels.
class Worst {
 public:
  void add(JudgedFrame frame) {
    for (const VisibleObject& object : frame.missed) frame.missed_pixels += object.pixels;
    frames_.push_back(std::move(frame));
    std::ranges::stable_sort(frames_, std::greater<>(), &JudgedFrame::missed_pixels);
    if (frames_.size() > kMost) frames_.pop_back();
  }
  cv::Mat sheet(const ClassNames& names) const {
    constexpr int kColumns = 3, kWidth = 480, kHeight = 360;
    const int rows = (static_cast<int>(frames_.size()) + kColumns - 1) / kColumns;
    cv::Mat sheet(rows * kHeight, kColumns * kWidth, CV_8UC3, cv::Scalar::all(255));
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const JudgedFrame& f = frames_[i];
      const int k = static_cast<int>(i);
      cv::Mat tile =
          sheet(cv::Rect(k % kColumns * kWidth, k / kColumns * kHeight, kWidth, kHeight));
      cv::resize(draw_missed(f.color, f.missed, f.found, names), tile, tile.size(), 0, 0,
                 cv::INTER_AREA);
    }
    return sheet;
  }

 private:
  static constexpr std::size_t kMost = 12;
  std::vector<JudgedFrame> frames_;
};

/// Scores of the detector and, on the same frames, of the level's simulated detector with the
/// measured settings.
struct JudgedRuns {
  DetectorScore real;
  std::optional<DetectorScore> simulated;
};

/// One frame of a scan, as the sensors deliver it.
struct Moment {
  SensedMoment sensed;
  SE3 world_from_camera;
};

/// Calls visit(moment, index) for evenly spaced frames of a handheld scan of each room.
void for_each_moment(const DetectorScoreArguments& options, const Robot& robot,
                     const SensorConfig& sensors,
                     const std::function<void(const Moment&, std::size_t)>& visit) {
  const std::vector<std::string> names = names_of(options);
  Progress progress("detector");
  std::size_t index = 0;
  for (std::size_t n = 0; n < names.size(); ++n) {
    std::vector<std::string> warnings;
    Scene scene = load_scene(names[n], &warnings);
    light_from_cache(scene, options.threads, usual_cache(options.detector.cache));
    for (const std::string& warning : warnings) progress.say("warning: " + warning);
    const std::shared_ptr<const Renderer> renderer = make_scene_renderer(scene);
    const Trajectory scan = travel(scene, robot, "handheld").camera;
    for (std::size_t k = 0; k < options.frames; ++k, ++index) {
      ScanMoment moment = scan_moment(scan, k, options.frames);
      const Shutter shutter(renderer, robot.camera, std::move(moment.around), sensors);
      visit({sense_moment(shutter, sensors, LabelMode::kNone, moment.at, RandomStream(index)),
             shutter.path()[moment.at].world_from_camera},
            index);
    }
    progress.share(static_cast<double>(n + 1) / static_cast<double>(names.size()));
  }
  progress.end();
}

/// Judges the detector; then judges the simulated detector with the measured settings.
JudgedRuns judge(const DetectorScoreArguments& options, const DetectorSpec& asked, Worst* worst) {
  const Cache cache = options.detector.opened_cache("detector");
  DetectorSpec spec = asked;
  const double confidence = spec.settings.confidence;
  spec.settings.confidence = std::min(confidence, kLeastScore);
  const std::unique_ptr<Detector> detector = open_detector(spec);
  const Robot robot = load_robot(options.robot);
  const SensorConfig sensors = load_sensor_config(options.level);
  const KeepDetections keep = detections_in(cache);
  DetectorJudge real(confidence);
  std::vector<RenderedFrame> exact;  // reduced to what the simulated detector uses
  std::vector<SE3> poses;
  for_each_moment(options, robot, sensors, [&](const Moment& moment, std::size_t index) {
    const RgbdFrame& frame = moment.sensed.frame;
    const Detected found = detect_kept(*detector, frame, index, keep);
    if (!found.pixels.index.empty())
      throw InputError(fmt::format("{}: segments: only boxes are scored", asked.network.string()));
    JudgedFrame judged{.color = frame.color, .missed = {}, .found = {}};
    judged.missed = real.add(moment.sensed.exact, found.boxes, frame.depth_m);
    for (const DetectedBox& box : found.boxes)
      if (box.score >= confidence) judged.found.push_back(box);
    if (worst != nullptr) worst->add(std::move(judged));
    RenderedFrame& kept = exact.emplace_back();
    kept.classes = moment.sensed.exact.classes;
    kept.instances = moment.sensed.exact.instances;
    poses.push_back(moment.world_from_camera);
  });
  JudgedRuns both{.real = real.score(), .simulated = {}};
  LabelConfig fitted = sensors.labels;
  fitted.detector = with_measured(fitted.detector, both.real.dials);
  DetectorJudge simulated(0);
  for (std::size_t i = 0; i < exact.size(); ++i)
    simulated.add(exact[i], as_detected(detect(exact[i], fitted, poses[i], RandomStream(i))));
  both.simulated = simulated.score();
  return both;
}

std::string_view class_name(ClassId id, const char* none) {
  return id == kVoid || id == kBackground ? none : classes()[id].name;
}

std::string percent(double share) {
  return std::isnan(share) ? "-" : fmt::format("{:.1f}", 100 * share);
}

void print_dials(const DetectorConfig& real, const DetectorConfig& simulated) {
  const DetectorConfig published;
  fmt::print("\n{:<16}{:>10}{:>12}{:>12}\n", "dial", "measured", "simulated", "YOLOv3");
  const auto line = [&](const char* name, double DetectorConfig::*dial) {
    const auto figure = [](double v) { return std::isnan(v) ? "-" : fmt::format("{:.3f}", v); };
    fmt::print("{:<16}{:>10}{:>12}{:>12}\n", name, figure(real.*dial), figure(simulated.*dial),
               figure(published.*dial));
  };
  line("recall_small", &DetectorConfig::recall_small);
  line("recall_medium", &DetectorConfig::recall_medium);
  line("recall_large", &DetectorConfig::recall_large);
  line("confusion", &DetectorConfig::confusion);
  line("false_alarms", &DetectorConfig::false_alarms);
  line("box_sigma", &DetectorConfig::box_sigma);
}

/// The entries with the largest counts, as "table 12, bed 3".
template <class Key, class Name>
std::string most(const std::map<Key, std::size_t>& counts, const Name& name) {
  std::vector<std::pair<std::size_t, std::string>> all;
  for (const auto& [key, count] : counts)
    if (const std::string text = name(key); !text.empty()) all.emplace_back(count, text);
  std::ranges::stable_sort(all, std::greater<>(), [](const auto& e) { return e.first; });
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(12, all.size()); ++i)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", all[i].second, all[i].first);
  return text.empty() ? "none" : text;
}

void print_score(const JudgedRuns& judged) {
  const DetectorScore& s = judged.real;
  fmt::print("{}, {} of classes that COCO has\n\n", counted(s.images, "image"),
             counted(s.mean.truths, "object"));
  fmt::print("{:<16}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}   {:>6}{:>8}\n", "class", "objects", "AP",
             "AP50", "AP75", "small", "medium", "large", "right", "wrong");
  const auto line = [](std::string_view name, const AveragePrecision& p, const std::string& more) {
    fmt::print("{:<16}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}   {}\n", name, p.truths, percent(p.ap),
               percent(p.ap50), percent(p.ap75), percent(p.small), percent(p.medium),
               percent(p.large), more);
  };
  for (const ClassScore& of : s.classes)
    line(
        class_name(of.class_id, "?"), of.precision,
        fmt::format("{:>5.0f}%{:>7.0f}%",
                    100.0 * static_cast<double>(of.right) / static_cast<double>(of.objects),
                    100.0 * static_cast<double>(of.wrong_class) / static_cast<double>(of.objects)));
  line("mean", s.mean, "");
  fmt::print("\nconfused: {}\n", most(s.outcomes, [](const Outcome& o) {
               if (o.truth == kVoid || o.found == kVoid || o.truth == o.found) return std::string();
               return fmt::format("{} as {}", class_name(o.truth, "?"),
                                  class_name(o.found, "another of COCO's"));
             }));
  fmt::print("found where there is no object: {}\n", most(s.false_alarms, [](const auto& key) {
               return fmt::format("{} on {}", class_name(key.first, "another of COCO's"),
                                  class_name(key.second, "void"));
             }));
  fmt::print("badly placed: {}\n", s.badly_placed);
  fmt::print("labels filled as box: {} % of labeled pixels right, {} % of objects' pixels found\n",
             percent(s.box.right_share), percent(s.box.found_share));
  fmt::print("labels filled as foreground: {} % right, {} % found\n",
             percent(s.foreground.right_share), percent(s.foreground.found_share));
  print_dials(s.dials, judged.simulated->dials);
}

/// The value; null if it is unknown (NaN).
nlohmann::ordered_json known(double v) {
  return std::isnan(v) ? nlohmann::ordered_json() : nlohmann::ordered_json(v);
}

nlohmann::ordered_json to_json(const DetectorConfig& dials) {
  return {
      {"recall_small", known(dials.recall_small)}, {"recall_medium", known(dials.recall_medium)},
      {"recall_large", known(dials.recall_large)}, {"confusion", known(dials.confusion)},
      {"false_alarms", known(dials.false_alarms)}, {"box_sigma", known(dials.box_sigma)}};
}

nlohmann::ordered_json to_json(const AveragePrecision& p) {
  return {{"truths", p.truths},     {"ap", known(p.ap)},       {"ap50", known(p.ap50)},
          {"ap75", known(p.ap75)},  {"small", known(p.small)}, {"medium", known(p.medium)},
          {"large", known(p.large)}};
}

std::string json_of(const JudgedRuns& judged) {
  const DetectorScore& s = judged.real;
  nlohmann::ordered_json json = {{"images", s.images}, {"mean", to_json(s.mean)}};
  for (const ClassScore& of : s.classes) {
    nlohmann::ordered_json entry = to_json(of.precision);
    entry["found_right"] = of.right;
    entry["found_as_another"] = of.wrong_class;
    json["classes"][std::string(class_name(of.class_id, "?"))] = entry;
  }
  json["confusion"] = nlohmann::ordered_json::array();
  for (const auto& [outcome, count] : s.outcomes)
    json["confusion"].push_back(
        {{"truth", class_name(outcome.truth, "nothing")},
         {"found",
          outcome.found == kBackground ? "another of COCO's" : class_name(outcome.found, "missed")},
         {"count", count}});
  json["badly_placed"] = s.badly_placed;
  json["dials"] = to_json(s.dials);
  json["dials_of_simulated"] = to_json(judged.simulated->dials);
  return json.dump(2) + "\n";
}

DetectorSpec spec_of(DetectorScoreArguments& options) {
  resolve(options.level, Shipped::kLevel);
  resolve(options.robot, Shipped::kRobot);
  for (std::string& name : options.scenes) resolve(name, Shipped::kScene);
  for (auto name = options.scenes.begin(); name != options.scenes.end(); ++name)
    if (std::find(options.scenes.begin(), name, *name) != name)
      throw InputError(fmt::format("--scenes: {} is named twice", *name));
  const auto spec = options.detector.spec();
  if (!spec) throw InputError("no detector is given: name one with --network");
  if (spec->network.empty())
    throw InputError(
        fmt::format("{}: boxes from files do not belong to rendered rooms: name a network",
                    spec->boxes.string()));
  return *spec;
}

void score(DetectorScoreArguments options) {
  const DetectorSpec spec = spec_of(options);
  std::optional<OutputFolder> folder;
  if (!options.out.empty())
    folder.emplace(options.out, "detector score",
                   std::vector<std::string>{"score.json", "missed.png"});
  Worst worst;
  const ReadScope reading;
  const JudgedRuns judged = judge(options, spec, &worst);
  const cv::Mat missed = worst.sheet(open_detector(spec)->names());
  require_unchanged(reading.record());
  options.json ? fmt::print("{}", json_of(judged)) : print_score(judged);
  if (options.out.empty()) return;
  write_atomically(fs::path(options.out) / "score.json", json_of(judged));
  write_image(fs::path(options.out) / "missed.png", missed);
}

void fit(DetectorScoreArguments options) {
  const DetectorSpec spec = spec_of(options);
  resolve(options.base, Shipped::kLevel);
  std::vector<fs::path> read = {options.base,
                                options.level,
                                options.robot,
                                spec.network,
                                spec.config,
                                spec.classes,
                                options.detector.settings};
  read.insert(read.end(), options.scenes.begin(), options.scenes.end());
  require_writable(options.out, read);
  require_no_other_than_level(options.out);
  SensorConfig level = load_sensor_config(options.base);
  const ReadScope scope;
  const JudgedRuns judged = judge(options, spec, nullptr);
  require_unchanged(scope.record());
  require_not_read(options.out, scope.record());  // includes the files of scenes and robot
  if (judged.real.mean.truths == 0)
    throw InputError(fmt::format("no object in the {} is of COCO's classes: nothing is measured",
                                 counted(judged.real.images, "image")));
  const DetectorConfig& measured = judged.real.dials;
  level.labels.detector = with_measured(level.labels.detector, measured);
  const auto warn_of = [&](const char* name, double value) {
    if (std::isnan(value))
      fmt::print(stderr, "detector: warning: {} was not measured: it stays as in {}\n", name,
                 options.base);
  };
  warn_of("recall_small", measured.recall_small);
  warn_of("recall_medium", measured.recall_medium);
  warn_of("recall_large", measured.recall_large);
  warn_of("confusion", measured.confusion);
  warn_of("box_sigma", measured.box_sigma);
  write_atomically(
      options.out,
      fmt::format("# Level `{}` with the dials of the simulated detector as measured of {}\n"
                  "# ({} of {} at level `{}`): `modelhouse detector fit`.\n{}",
                  fs::path(options.base).stem().string(), spec.network.filename().string(),
                  counted(judged.real.images, "image"), counted(names_of(options).size(), "place"),
                  fs::path(options.level).stem().string(), format_sensor_config(level, false)));
  print_dials(judged.real.dials, judged.simulated->dials);
}

void add_common(CLI::App& command, const std::shared_ptr<DetectorScoreArguments>& options) {
  options->detector.add_to(command, "--network,--detector");
  command.add_option("--scenes", options->scenes,
                     "Scenes (default: generated rooms of every category)");
  command.add_option("--per-category", options->per_category, "Rooms of each category")
      ->check(CLI::Range(1, 1000));
  command
      .add_option("--frames", options->frames,
                  "Frames of each scene, evenly spaced along a handheld scan")
      ->check(CLI::Range(1, 100000));
  command.add_option("--level", options->level,
                     "Sensor level (YAML), or the name of a shipped one");
  command.add_option("--robot", options->robot,
                     "Robot whose camera is used (YAML), or the name of a shipped one");
  command
      .add_option("--threads", options->threads,
                  "Threads that bake light; does not affect the figures")
      ->check(CLI::Range(1, 256));
}

}  // namespace

void add_detector_score(CLI::App& detector) {
  auto options = std::make_shared<DetectorScoreArguments>();
  CLI::App* s = detector.add_subcommand(
      "score", "Average precision per class on rendered rooms, and which classes are confused.");
  add_common(*s, options);
  s->add_option("--out", options->out,
                "Folder for score.json and missed.png (what it missed most)");
  s->add_flag("--json", options->json, "Prints JSON");
  s->footer("Example:\n  modelhouse detector score --network yolox_nano.onnx --out out/score");
  s->callback([options] { score(*options); });

  auto of_fit = std::make_shared<DetectorScoreArguments>();
  CLI::App* f = detector.add_subcommand(
      "fit",
      "Writes a sensor level whose simulated detector has the errors measured for the real one.");
  add_common(*f, of_fit);
  f->add_option("--base", of_fit->base, "Level that provides all other settings");
  f->add_option("--out", of_fit->out, "Level to write (YAML)")->required();
  f->footer(
      "Example:\n  modelhouse detector fit --network yolox_nano.onnx --base pepper "
      "--out out/pepper_fitted.yaml");
  f->callback([of_fit] { fit(*of_fit); });
}

}  // namespace mh::cli
