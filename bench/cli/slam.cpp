// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <sstream>

#include <fmt/format.h>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/detector_option.hpp"
#include "bench/cli/progress.hpp"
#include "bench/cli/sequence_source.hpp"
#include "bench/cli/slam_report.hpp"
#include "bench/protocol/world/cached_detections.hpp"
#include "bench/protocol/world/parts.hpp"
#include "bench/run/one/run_one.hpp"
#include "bench/systems/builtin.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/files/map_file.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"

namespace mh::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct SlamArguments : SourceOptions {
  std::string vocabulary = "vocabulary", out, map, save_map, truth;
  DetectorOption detector;
  std::optional<double> gamma, xi;
  bool plain = false, localize = false, resume = false, protocol = false;
  std::size_t frames = SIZE_MAX;
};

/// Applies the settings that --settings may change for a loaded map: those of relocalization. All
/// other settings shaped the map, so the map's values are kept, and a note lists those that the
/// file would have changed.
void apply_settings(const SlamArguments& options, SlamConfig& of_map,
                    std::vector<std::string>& notes) {
  const SlamConfig asked = load_settings(options.settings, of_map).slam;
  of_map.relocalize = asked.relocalize;
  std::istringstream kept(format_slam_config(of_map)), wanted(format_slam_config(asked));
  std::string list, section, line;
  for (std::string other; std::getline(kept, line) && std::getline(wanted, other);) {
    if (!line.starts_with(' ')) section = line.substr(0, line.find(':'));
    if (line != other)
      list += fmt::format("{}{}.{}", list.empty() ? "" : ", ", section, line.substr(2));
  }
  if (!list.empty())
    notes.push_back(fmt::format("{}: the map's own settings are used: {}", options.settings, list));
}

/// Returns a new state, or the state in the map file.
SlamState first_state(const SlamArguments& options,
                      const std::shared_ptr<const Vocabulary>& vocabulary, Settings& settings) {
  SlamState state;
  if (options.map.empty()) {
    state = make_slam(settings.camera, settings.slam, vocabulary);
  } else {
    state = load_slam(options.map, vocabulary);
    Camera made_by = state.camera;  // without the learned disparity_sigma_px
    if (!made_by.disparity_sigma_is_given) made_by.disparity_sigma_px = Camera{}.disparity_sigma_px;
    if (made_by != settings.camera)
      throw InputError(fmt::format("{}: was made with a different camera", options.map));
    if (!options.settings.empty()) apply_settings(options, state.config, settings.notes);
    if (!options.resume) {  // the map's frames are from a different sequence
      rewind(state);
      state.tracked_frames.clear();
    }
  }
  SemanticConfig semantics = state.config.semantics;
  if (options.gamma) semantics.gamma = *options.gamma;
  if (options.xi) semantics.xi = *options.xi;
  if (options.plain) semantics = semantics.neutralized();
  set_query_settings(state, semantics);
  settings.slam = state.config;
  return state;
}

void check(const SlamArguments& options) {
  options.check();
  if (options.localize && options.map.empty())
    throw InputError("--localize needs a map: name one with --map");
  if (options.resume && options.map.empty())
    throw InputError("--resume needs a map: name one with --map");
  if (options.resume && options.protocol)
    throw InputError("--protocol and --resume: held-out frames need a whole run");
}

/// Returns the index of the first frame that the map has not received yet.
/// @throws InputError if none is left
std::size_t first_frame(const SlamArguments& options, const SlamState& state,
                        const Sequence& frames) {
  if (!options.resume) return 0;
  if (!state.last_stamp_ns)
    throw InputError(fmt::format("{}: holds no run that could be resumed", options.map));
  std::size_t first = 0;
  Stamp last_ns = -1;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    last_ns = std::max(last_ns, frames.stamp_ns(i));
    if (last_ns <= *state.last_stamp_ns) first = i + 1;
  }
  if (first == frames.size())
    throw InputError(fmt::format(
        "{}: nothing is left to resume: it ends at {} s, and the run in {} got as far as {} s",
        options.source, format_stamp(last_ns), options.map, format_stamp(*state.last_stamp_ns)));
  return first;
}

/// A map may replace another map, but no other file.
void require_no_other_file(const fs::path& map) {
  std::error_code error;
  if (fs::exists(map, error) && fs::file_size(map, error) > 0 && !is_map_file(map))
    throw InputError(
        fmt::format("--save-map {}: is not a map file: choose another name", map.string()));
}

/// Runs one sequence, under the bench's protocol or as a live camera feed without held-out frames.
RunResult run_sequence(const SlamArguments& options, const World& world, SlamState& state,
                       std::size_t first, const StepObservers& observers,
                       const MappingObserver& watch) {
  // As in the original ORB-SLAM2, a map of at most this many keyframes is reset when tracking is
  // lost. Under the bench's protocol, the feed rewinds instead.
  constexpr int kSmallMap = 5;
  RunSpec spec;
  spec.environment.sequence = options.source;
  spec.seed = options.seed;
  spec.slam = state.config;
  spec.points = {state.config.semantics};
  if (!options.protocol) spec.protocol = live_feed();
  const BuiltinOptions ours{.observers = observers, .small_map = options.protocol ? 0 : kSmallMap};
  if (!options.localize)
    return run_one(
        spec, world,
        {.system = [&](const RunSpec&, const World&) { return make_builtin_system(state, ours); },
         .observe = watch,
         .first = first,
         .occupancy = false});
  const auto frozen = make_builtin_system(state, ours);
  frozen->freeze();
  Localization found =
      localize_sequence(*frozen, *world.mapping, spec.protocol, RandomStream(options.seed), watch);
  RunResult run;
  run.spec = std::move(spec);
  run.mapping = std::move(found.outcome);
  run.estimate = std::move(found.trajectory);
  return run;
}

void run(SlamArguments options) {
  check(options);
  resolve(options.vocabulary, Shipped::kVocabulary);
  resolve(options.settings, Shipped::kSettings);
  const ReadScope reading;
  const auto vocabulary = std::make_shared<const Vocabulary>(Vocabulary::load(options.vocabulary));
  const auto spec = options.detector.spec();
  options.labels = !options.plain && !spec;  // unused labels are not read
  Source source = open_source(options);
  // Checked before the work, so that a mistake costs no time.
  if (spec) {
    const std::shared_ptr<const Detector> detector = open_detector(*spec);
    fmt::print(stderr, "slam: labels from {}\n", detector->description());
    if (const std::string note = detector->check_frames(stamps_of(*source.frames)); !note.empty())
      fmt::print(stderr, "slam: warning: {}\n", note);
    source.frames = std::make_unique<DetectedSequence>(
        std::shared_ptr<const Sequence>(std::move(source.frames)), detector, spec->settings.fill,
        detections_in(options.detector.opened_cache("slam")));
  }
  std::optional<Trajectory> named_truth;
  if (!options.truth.empty()) {
    named_truth = read_trajectory(options.truth, &source.settings.notes);
    if (const std::string note = truth_of_another_time(*source.frames, *named_truth); !note.empty())
      source.settings.notes.push_back(fmt::format("{}: {}", options.truth, note));
  }
  const OutputFolder folder(options.out, "slam", {kSlamFiles.begin(), kSlamFiles.end()});
  for (const char* name : kSlamFiles) {
    const fs::path file = fs::path(options.out) / name;
    require_writable(file);
    if (!options.save_map.empty() &&
        fs::absolute(file).lexically_normal() == fs::absolute(options.save_map).lexically_normal())
      throw InputError(fmt::format(
          "--save-map {}: is the name of another result: choose another name", options.save_map));
  }
  if (!options.save_map.empty()) {
    require_writable(options.save_map,
                     {options.vocabulary, options.settings, options.truth, options.source});
    require_no_other_file(options.save_map);
  }
  SlamState state = first_state(options, vocabulary, source.settings);
  const std::size_t first = first_frame(options, state, *source.frames);
  for (const std::string& note : source.settings.notes) fmt::print(stderr, "slam: {}\n", note);
  const std::size_t end = first + std::min(options.frames, source.frames->size() - first);
  const World world{.mapping = first_frames(std::move(source.frames), end, named_truth),
                    .query_tour = nullptr,
                    .simulated = {},
                    .vocabulary = vocabulary,
                    .cut = false,
                    .inputs = {}};

  Progress progress("slam");
  StageClock clock;
  FrameLog log;
  std::vector<double> frame_ms;
  double running_ms = 0;
  const StepObservers observers{.stage = [&](Stage stage, StageEvent e) { clock(stage, e); },
                                .matches = nullptr};
  const auto watch = [&](const MappedFrame& call, const RgbdFrame&, const SystemReport& report) {
    log.add(call, report);
    clock.end_frame();
    double ms = 0;
    for (const double stage_ms : clock.frames().back()) ms += stage_ms;
    frame_ms.push_back(ms);
    running_ms += ms;
    progress.share(static_cast<double>(call.index + 1 - first) / static_cast<double>(end - first),
                   fmt::format("{} tracked, {}, {}, SLAM {:.1f} ms a frame", log.tracked,
                               counted(state.map.keyframe_count(), "keyframe"),
                               counted(state.map.landmark_count(), "landmark"),
                               running_ms / static_cast<double>(frame_ms.size())));
  };
  const RunResult result = run_sequence(options, world, state, first, observers, watch);
  if (state.map.empty())
    throw InputError(nothing_mapped(options.source, *world.mapping, first, result.mapping.offered));
  require_unchanged(reading.record());
  if (!options.save_map.empty()) save_slam(options.save_map, state);

  const Trajectory* truth = world.mapping->truth();
  const SlamReport report{
      .state = state,
      .run = result,
      .log = log,
      .clock = clock,
      .frame_ms = std::move(frame_ms),
      .evaluation = truth ? std::optional(evaluate(*truth, result.estimate)) : std::nullopt,
      .frames_csv = log.csv(*world.mapping, result.spec.protocol, first),
      .source = options.source};
  progress.end();
  write_slam_files(options.out, report, source.settings);
  print_slam_report(report);
}

}  // namespace

void add_slam(CLI::App& app) {
  auto options = std::make_shared<SlamArguments>();
  CLI::App* command =
      app.add_subcommand("slam", "Runs SLAM on a recorded sequence or along a tour of a scene.");
  options->add_to(*command);
  command->add_option("--vocabulary", options->vocabulary,
                      "Vocabulary file, or the name of the shipped one");
  command->add_option("--out", options->out, "Folder for the results")->required();
  command->add_option("--map", options->map, "Map file to start from");
  CLI::Option* localize =
      command->add_flag("--localize", options->localize, "Only localizes: the map stays as it is");
  command->add_flag("--resume", options->resume, "Resumes the sequence where the map's run stopped")
      ->excludes(localize);
  command
      ->add_flag("--protocol", options->protocol,
                 "Runs as in a suite: frames are held out and queried after mapping, and the feed "
                 "goes back when tracking is lost")
      ->excludes(localize);
  command->add_option("--save-map", options->save_map, "Map file to write")->excludes(localize);
  command->add_option(
      "--truth", options->truth,
      "True trajectory, TUM text or EuRoC CSV (default: the folder's groundtruth.txt "
      "or groundtruth.csv)");
  command->add_option("--frames", options->frames, "At most this many frames")
      ->default_str("all")
      ->check(CLI::Range(1, 100000000));
  const std::vector<CLI::Option*> detector = options->detector.add_to(*command);
  CLI::Option* gamma = command
                           ->add_option("--gamma", options->gamma,
                                        "Weight of a label, equation 1 (default: the settings')")
                           ->check(number_between(0.0, 1e6));
  CLI::Option* xi =
      command
          ->add_option("--xi", options->xi,
                       "Penalty for labels that differ, equation 2 (default: the settings')")
          ->check(number_between(1.0, 1e6));
  CLI::Option* plain = command->add_flag("--plain", options->plain, "Runs without semantics");
  plain->excludes(gamma, xi);
  for (CLI::Option* option : detector) plain->excludes(option);
  command->add_flag_callback(
      "--print-settings",
      [] {
        fmt::print("{}", format_slam_config({}, true));
        throw CLI::Success();
      },
      "Prints every setting with its default, meaning and range");
  command->footer(
      "Example:\n  modelhouse slam out/sequence --out out/slam --save-map out/house.mhmap");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
