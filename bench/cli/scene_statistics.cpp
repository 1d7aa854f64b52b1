// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/progress.hpp"
#include "bench/cli/scene_option.hpp"
#include "bench/cli/usual_cache.hpp"
#include "bench/lab/survey.hpp"
#include "bench/protocol/world/cached_light.hpp"
#include "scenes/image_file.hpp"
#include "scenes/load.hpp"
#include "scenes/recordings/tum_folder.hpp"
#include "sim/simulation/lit_scene.hpp"
#include "sim/simulation/simulated_sequence.hpp"
#include "sim/simulation/travel.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"

namespace mh::cli {
namespace {

namespace fs = std::filesystem;

struct SceneStatisticsArguments {
  std::vector<std::string> scenes;
  std::string level, robot, reference, tum, cache;
  int per_category = 0;
  std::size_t frames = 600;
  int threads = 2;
  bool json = false;
  SceneFrameOption frame;
};

std::vector<std::string> names_of(const SceneStatisticsArguments& options) {
  return options.scenes.empty() ? generated_rooms(options.per_category) : options.scenes;
}

/// Measures evenly spaced frames of a handheld scan of the scene, with the effects of the level's
/// sensors.
MeasuredPlace measure_scene(const std::string& name, std::size_t frames,
                            const SceneStatisticsArguments& options, const Robot& robot,
                            const SensorConfig& sensors) {
  std::vector<std::string> warnings;
  Scene scene = load_scene(name, &warnings, options.frame.frame());
  light_from_cache(scene, options.threads, usual_cache(options.cache));
  print_warnings(warnings);
  const std::shared_ptr<const Renderer> renderer = make_scene_renderer(scene);
  const Trajectory scan = travel(scene, robot, "handheld").camera;
  MeasuredPlace place{.name = name, .frames = {}};
  for (std::size_t k = 0; k < frames; ++k) {
    ScanMoment moment = scan_moment(scan, k, frames);
    const SimulatedSequence sequence(renderer, robot.camera, std::move(moment.around), sensors,
                                     LabelMode::kNone);
    place.frames.push_back(measure_image(sequence.frame(moment.at, RandomStream(k)).color));
  }
  return place;
}

MeasuredPlace measure_recording(const fs::path& folder) {
  MeasuredPlace place{.name = folder.string(), .frames = {}};
  for (const RecordedFrame& frame : load_tum_folder(folder)) {
    place.frames.push_back(measure_image(read_image(frame.color, ImageForm::kGray)));
  }
  return place;
}

void print_table(const std::vector<MeasuredPlace>& places, const std::vector<RealFrames>& real,
                 const std::optional<MeasuredPlace>& recording) {
  std::size_t frames = 0;
  for (const MeasuredPlace& place : places) frames += place.frames.size();
  fmt::print("{} of {}; percentiles 5 / 25 / 50 / 75 / 95\n", counted(frames, "frame"),
             counted(places.size(), "place"));
  for (std::size_t q = 0; q < kImageQuantityCount; ++q) {
    fmt::print("\n{}\n", kImageQuantities[q].name);
    const auto line = [](const std::string& name, const std::array<double, 5>& p,
                         const std::string& more) {
      fmt::print("  {:<14}{:>8}{:>8}{:>8}{:>8}{:>8}   {}\n", name, shown(p[0]), shown(p[1]),
                 shown(p[2]), shown(p[3]), shown(p[4]), more);
    };
    const RealismRow row = compare(places, real.front(), q);
    line("generated", row.ours,
         fmt::format("median of places {} {} the middle half of {}; spread {:.2f} of it",
                     shown(row.median_of_places), row.in_range ? "within" : "OUTSIDE",
                     real.front().name, row.spread_ratio));
    for (const RealFrames& set : real) line(set.name, set.percentiles[q], "");
    if (recording) {
      std::array<double, 5> measured{};
      for (std::size_t k = 0; k < kShares.size(); ++k) measured[k] = recording->at(q, kShares[k]);
      line("recording", measured,
           fmt::format("{}, measured now", counted(recording->frames.size(), "frame")));
    }
    if (row.outside.empty()) continue;
    std::vector<std::string> outside;
    for (const std::size_t i : row.outside)
      outside.push_back(fmt::format("{} ({})", places[i].name, shown(places[i].at(q, 0.5))));
    fmt::print("  {} whose median is outside {}'s 5 to 95 %: {}\n",
               counted(outside.size(), "place"), real.front().name, fmt::join(outside, ", "));
  }
}

void print_json(const std::vector<MeasuredPlace>& places, const RealFrames& real) {
  nlohmann::ordered_json json, list = nlohmann::ordered_json::array();
  for (std::size_t q = 0; q < kImageQuantityCount; ++q) {
    const RealismRow row = compare(places, real, q);
    json["quantities"][std::string(kImageQuantities[q].key)] = {{"percentiles", row.ours},
                                                                {"real", real.percentiles[q]},
                                                                {"median", row.median_of_places},
                                                                {"in_range", row.in_range},
                                                                {"spread_ratio", row.spread_ratio}};
  }
  for (const MeasuredPlace& place : places) {
    nlohmann::ordered_json entry = {{"scene", place.name}, {"frames", place.frames.size()}};
    for (std::size_t q = 0; q < kImageQuantityCount; ++q)
      entry[std::string(kImageQuantities[q].key)] = place.at(q, 0.5);
    list.push_back(entry);
  }
  json["places"] = list;
  fmt::print("{}\n", json.dump(2));
}

void run(SceneStatisticsArguments options) {
  resolve(options.level, Shipped::kLevel);
  resolve(options.robot, Shipped::kRobot);
  for (std::string& name : options.scenes) resolve(name, Shipped::kScene);
  const std::vector<RealFrames> real =
      load_real_frames(options.reference.empty() ? data_folder() / "assets/real_frames.yaml"
                                                 : fs::path(options.reference));
  const Robot robot = load_robot(options.robot);
  const SensorConfig sensors = load_sensor_config(options.level);
  const std::vector<std::string> names = names_of(options);
  std::optional<MeasuredPlace> recording;
  if (!options.tum.empty()) recording = measure_recording(options.tum);
  Progress progress("statistics");
  std::vector<MeasuredPlace> places;
  for (std::size_t i = 0; i < names.size(); ++i) {
    // Over all places, these add up to the requested number of frames.
    const std::size_t frames =
        (i + 1) * options.frames / names.size() - i * options.frames / names.size();
    if (frames > 0) places.push_back(measure_scene(names[i], frames, options, robot, sensors));
    progress.share(static_cast<double>(i + 1) / static_cast<double>(names.size()));
  }
  progress.end();
  options.json ? print_json(places, real.front()) : print_table(places, real, recording);
}

}  // namespace

void add_scene_statistics(CLI::App& scene) {
  auto options = std::make_shared<SceneStatisticsArguments>();
  options->level = "handheld";
  options->robot = "pepper";
  CLI::App* command = scene.add_subcommand(
      "statistics", "Compares rendered frames with real ones: texture, blankness, sharpness.");
  command->add_option("scenes", options->scenes, "Scenes (default: those of every category)");
  command
      ->add_option("--per-category", options->per_category,
                   "Scenes of each category, at most (default: all)")
      ->check(CLI::Range(1, 1000));
  command->add_option("--frames", options->frames, "Frames of all scenes together")
      ->check(CLI::Range(1, 1000000));
  command->add_option("--level", options->level,
                      "Sensor level (YAML), or the name of a shipped one");
  command->add_option("--robot", options->robot,
                      "Robot whose camera is used (YAML), or the name of a shipped one");
  command->add_option("--reference", options->reference,
                      "Figures of real frames (YAML) (default: the shipped ones)");
  command->add_option("--tum", options->tum,
                      "Folder of real frames in TUM's layout, which are measured, too");
  options->frame.add_to(*command);
  command
      ->add_option("--jobs", options->threads,
                   "Threads that bake light; does not affect the figures")
      ->check(CLI::Range(1, 1024));
  command->add_option("--cache", options->cache,
                      "Cache folder for baked light (default: $XDG_CACHE_HOME/modelhouse)");
  command->add_flag("--json", options->json, "Prints JSON, with the median of each scene");
  command->footer("Example:\n  modelhouse scene statistics --per-category 3 --frames 540");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
