// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/progress.hpp"
#include "bench/cli/scene_option.hpp"
#include "bench/cli/usual_cache.hpp"
#include "bench/lab/twin.hpp"
#include "bench/protocol/world/cached_light.hpp"
#include "bench/report/drawing/contact_sheet.hpp"
#include "bench/report/results_json.hpp"
#include "bench/results/rows.hpp"
#include "bench/run/one/run_one.hpp"
#include "bench/suite/recorded_camera.hpp"
#include "bench/suite/shipped.hpp"
#include "scenes/load.hpp"
#include "scenes/recordings/images/write_image.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "scenes/scannet/files.hpp"
#include "scenes/scannet/scene_info.hpp"
#include "sim/sensors/sense.hpp"
#include "sim/simulation/lit_scene.hpp"
#include "sim/simulation/simulated_sequence.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/text_file.hpp"

namespace mh::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 2> kFiles{"pairs.png", "twin.json"};

struct TwinArguments {
  std::string recording, scene, settings, level = "handheld", vocabulary = "vocabulary", cache, out;
  std::vector<double> scene_from_recording;
  std::size_t frames = SIZE_MAX, every = 5;
  std::uint64_t seed = 0;
  int threads = 2;
  bool plain_comparison = false;  ///< compare only images, without maps
  SceneFrameOption frame;
};

/// Transform from the frame of the recording's poses to the frame of the scene. If it is not given,
/// it is ScanNet's alignment, which the scene's loader applies to the scene but not to the
/// recording's poses.
SE3 scene_from_recording(const TwinArguments& options) {
  if (!options.scene_from_recording.empty()) {
    const std::vector<double>& v = options.scene_from_recording;
    const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
    if (!(rotation.norm() > 1e-6))
      throw InputError("--scene-from-recording: the quaternion (qx qy qz qw) is 0");
    return {rotation.normalized().toRotationMatrix(), Eigen::Vector3d(v[0], v[1], v[2])};
  }
  if (!is_scannet_scene(options.scene)) return {};
  const fs::path folder = options.scene;
  const fs::path file = folder / (fs::weakly_canonical(folder).filename().string() + ".txt");
  if (!is_file(file)) return {};
  const ScannetInfo info = parse_scannet_info(read_text(file), file.string());
  if (!info.aligned_from_scan) return {};
  return {info.aligned_from_scan->topLeftCorner<3, 3>(),
          info.aligned_from_scan->topRightCorner<3, 1>()};
}

/// A map from one kind of frames (recorded or rendered), and its answers to queries of both kinds
/// at the same times.
struct Mapped {
  MappingOutcome mapping;
  TrajectoryScore trajectory;
  QuerySummary own, other;
};

Mapped map_and_ask(std::shared_ptr<const Sequence> mapped, std::shared_ptr<const Sequence> other,
                   const std::shared_ptr<const Vocabulary>& vocabulary, std::uint64_t seed) {
  RunSpec spec;
  spec.seed = seed;
  spec.system = {.kind = SystemKind::kPlain, .name = "plain", .outside = {}};
  spec.slam = settings_of(spec.system, {});
  spec.points = {spec.slam->semantics};
  const World world{.mapping = std::move(mapped),
                    .query_tour = std::move(other),
                    .simulated = {},
                    .vocabulary = vocabulary,
                    .cut = false,
                    .inputs = {}};
  const RunResult run = run_one(spec, world, {.occupancy = false});
  return {run.mapping, run.trajectory, summarize(run.points.front().held_out),
          summarize(run.points.front().second_tour)};
}

nlohmann::ordered_json as_json(const KeypointAgreement& a) {
  return {{"keypoints", a.keypoints},
          {"repeated", a.repeated},
          {"matched", a.matched},
          {"mismatched", a.mismatched}};
}

nlohmann::ordered_json as_json(const Mapped& m) {
  nlohmann::ordered_json json = figures_json(figures_of(m.trajectory));
  json["restarts"] = m.mapping.restarts;
  json["own_queries"] = figures_json(figures_of(m.own));
  json["other_queries"] = figures_json(figures_of(m.other));
  return json;
}

std::string percent(const std::optional<double>& share) {
  return share ? fmt::format("{:.1f} %", 100 * *share) : "-";
}

void print(const std::vector<TwinFrame>& frames, const std::vector<TwinRow>& rows,
           const std::optional<std::pair<Mapped, Mapped>>& maps) {
  fmt::print("{} compared; medians over frames\n{:<48}{:>12}{:>12}\n",
             counted(frames.size(), "frame"), "", "recorded", "rendered");
  for (const TwinRow& row : rows)
    fmt::print("{:<48}{:>12}{:>12}\n", row.name, shown(row.recorded), shown(row.rendered));
  fmt::print(
      "(for the last three, \"rendered\" is a bound: the same rendering with different noise)\n");
  std::vector<double> differences;
  for (const TwinFrame& frame : frames)
    if (frame.depth_difference_m) differences.push_back(*frame.depth_difference_m);
  if (!differences.empty())
    fmt::print("{:<48}{:>12}\n", "depth, rendered minus recorded, median of medians (m)",
               shown(percentile(differences, 0.5)));
  if (!maps) return;
  fmt::print("\n{:<20}{:>10}{:>10}{:>10}{:>24}{:>24}\n", "map of", "complete", "ATE m", "restarts",
             "recorded queries", "rendered queries");
  for (const auto& [name, m, recorded, rendered] :
       {std::tuple{"recorded frames", &maps->first, &maps->first.own, &maps->first.other},
        std::tuple{"rendered frames", &maps->second, &maps->second.other, &maps->second.own}})
    fmt::print("{:<20}{:>10}{:>10}{:>10}{:>24}{:>24}\n", name, percent(m->trajectory.completeness),
               m->trajectory.ate_rmse_m ? fmt::format("{:.4f}", *m->trajectory.ate_rmse_m) : "-",
               m->mapping.restarts,
               fmt::format("{} of {}", percent(recorded->correct), recorded->queries),
               fmt::format("{} of {}", percent(rendered->correct), rendered->queries));
}

/// Up to six evenly spaced frames, with each recorded image beside its rendering.
cv::Mat draw_pairs(const Sequence& recorded, const Sequence& twin) {
  constexpr std::size_t kPairs = 6;
  std::vector<View> views;
  const std::size_t count = std::min(kPairs, recorded.size());
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = (2 * k + 1) * recorded.size() / (2 * count);
    try {
      RgbdFrame real = recorded.frame(i, RandomStream(0).fork(i));
      views.push_back({fmt::format("recorded, frame {}", i), std::move(real.color), {}, {}});
    } catch (const InputError&) {
      continue;
    }
    views.push_back({"rendered", twin.frame(i, RandomStream(1).fork(i)).color, {}, {}});
  }
  return draw_gallery(views, 2, true);
}

void run(TwinArguments options) {
  resolve(options.vocabulary, Shipped::kVocabulary);
  resolve(options.level, Shipped::kLevel);
  resolve(options.settings, Shipped::kSettings);
  resolve(options.scene, Shipped::kScene);
  const ReadScope reading;
  RecordingConfig config{.calibration = options.settings, .classes = {}, .labels = false};
  config.read_camera = camera_reader(nullptr);
  OpenedRecording opened = open_sequence(options.recording, config);
  for (const std::string& note : opened.notes) fmt::print(stderr, "twin: {}\n", note);
  const SensorConfig sensors = load_sensor_config(options.level);
  const auto vocabulary = std::make_shared<const Vocabulary>(Vocabulary::load(options.vocabulary));
  const OutputFolder folder(options.out, "twin", {kFiles.begin(), kFiles.end()});
  const auto recorded = [&] {
    try {
      return std::make_shared<const PosedFrames>(std::move(opened.sequence),
                                                 scene_from_recording(options), options.frames);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", options.recording, error.what()));
    }
  }();
  if (recorded->left_out() > 0)
    fmt::print(stderr, "twin: {} without a true pose left out\n",
               counted(recorded->left_out(), "frame"));

  std::vector<std::string> warnings;
  Scene scene = load_scene(options.scene, &warnings, options.frame.frame());
  print_warnings(warnings);
  light_from_cache(scene, options.threads, usual_cache(options.cache));
  const auto twin =
      std::make_shared<const SimulatedSequence>(make_scene_renderer(scene), recorded->camera(),
                                                *recorded->truth(), sensors, LabelMode::kNone);

  Progress progress("twin");
  const std::vector<TwinFrame> frames =
      compare_twins(*recorded, *twin, FeatureConfig{}, options.every,
                    [&](double share) { progress.share(share, "comparing frames"); });
  if (frames.empty()) throw InputError(options.recording + ": no frame can be read");
  std::optional<std::pair<Mapped, Mapped>> maps;
  if (!options.plain_comparison) {
    progress.share(1, "mapping the recording");
    Mapped of_recorded = map_and_ask(recorded, twin, vocabulary, options.seed);
    progress.share(1, "mapping the twin");
    maps.emplace(std::move(of_recorded), map_and_ask(twin, recorded, vocabulary, options.seed));
  }
  progress.end();

  const cv::Mat pairs = draw_pairs(*recorded, *twin);
  require_unchanged(reading.record());
  write_image(fs::path(options.out) / "pairs.png", pairs);
  const std::vector<TwinRow> rows = summarize(frames);
  nlohmann::ordered_json json = {{"recording", options.recording},
                                 {"scene", options.scene},
                                 {"level", options.level},
                                 {"frames_with_pose", recorded->size()},
                                 {"frames_left_out", recorded->left_out()}};
  for (const TwinRow& row : rows)
    json["medians"][row.key] = {{"recorded", row.recorded}, {"rendered", row.rendered}};
  for (const TwinFrame& f : frames)
    json["frames"].push_back(
        {{"stamp_ns", f.stamp_ns},
         {"recorded", f.recorded},
         {"rendered", f.rendered},
         {"recorded_depth_share", f.recorded_depth_share},
         {"rendered_depth_share", f.rendered_depth_share},
         {"depth_difference_m", f.depth_difference_m ? nlohmann::ordered_json(*f.depth_difference_m)
                                                     : nlohmann::ordered_json()},
         {"across", as_json(f.across)},
         {"noise", as_json(f.noise)}});
  if (maps) json["map_of_recorded"] = as_json(maps->first);
  if (maps) json["map_of_rendered"] = as_json(maps->second);
  write_atomically(fs::path(options.out) / "twin.json", json.dump(2) + "\n");
  print(frames, rows, maps);
  fmt::print("{} beside each other: {}\n", "recorded and rendered frames",
             (fs::path(options.out) / "pairs.png").string());
}

}  // namespace

void add_twin(CLI::App& app) {
  auto options = std::make_shared<TwinArguments>();
  CLI::App* command = app.add_subcommand(
      "twin", "Renders the scene of a recording along its poses and compares the two.");
  command->add_option("recording", options->recording, sequence_forms())->required();
  command->add_option("scene", options->scene, "Mesh of the same place")->required();
  command->add_option("--out", options->out, "Folder for pairs.png and twin.json")->required();
  command->add_option("--settings", options->settings,
                      "Calibration (default: that of the recording)");
  command->add_option("--level", options->level, "Sensor level of the rendering");
  command
      ->add_option("--scene-from-recording", options->scene_from_recording,
                   "tx ty tz qx qy qz qw: from the frame of the recording's poses to the scene's "
                   "(default: ScanNet's alignment, otherwise none)")
      ->expected(7);
  command->add_option("--frames", options->frames, "At most this many frames with a pose");
  command->add_option("--every", options->every, "Compares every n-th frame only")
      ->check(CLI::Range(1, 1000000));
  command->add_flag("--no-maps", options->plain_comparison, "Compares only images, makes no maps");
  command->add_option("--vocabulary", options->vocabulary, "Vocabulary of the maps");
  command->add_option("--seed", options->seed, "Seed of SLAM's random draws");
  command
      ->add_option("--jobs", options->threads,
                   "Threads that bake light; does not affect the figures")
      ->check(CLI::Range(1, 1024));
  command->add_option("--cache", options->cache,
                      "Cache folder for baked light (default: $XDG_CACHE_HOME/modelhouse)");
  options->frame.add_to(*command);
  command->footer(
      "Example:\n  modelhouse twin scannet:scans/scene0000_00 scans/scene0000_00 --out out/twin");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
