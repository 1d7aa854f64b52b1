// SPDX-License-Identifier: Apache-2.0
#include "bench/cli/sequence_source.hpp"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/cli/arguments.hpp"
#include "bench/cli/usual_cache.hpp"
#include "bench/protocol/world/cached_light.hpp"
#include "bench/results/statistics.hpp"
#include "bench/suite/recorded_camera.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "sim/simulation/scene_drive.hpp"
#include "slam/features/undistort.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"

namespace mh::cli {
namespace {

constexpr const char* kUsualRobot = "pepper";

/// Settings for a source with its own camera, which replaces the camera of a settings file.
Settings settings_beside(const SourceOptions& options, const Sequence& frames,
                         std::vector<std::string> notes) {
  Settings settings;
  if (!options.settings.empty()) {
    Settings named = load_settings(options.settings);
    settings.slam = named.slam;
    settings.notes = std::move(named.notes);
    if (named.has_camera && named.camera != frames.camera())
      settings.notes.push_back(fmt::format("{}: its camera is replaced by that of {}",
                                           options.settings, options.source));
  }
  settings.notes.insert(settings.notes.end(), notes.begin(), notes.end());
  settings.camera = frames.camera();
  return settings;
}

}  // namespace

void SourceOptions::add_to(CLI::App& command) {
  command
      .add_option("source", source,
                  sequence_forms() + ", a path whose layout is recognized, or scene:FILE")
      ->required();
  command.add_option("--settings", settings,
                     "Settings (YAML), also ORB-SLAM2's, or the name of shipped ones (default: the "
                     "folder's camera.yaml)");
  command.add_option("--classes", classes,
                     "What the labels of a recording mean (YAML), if they are not our classes");
  command.add_option("--topics", topics,
                     "Topics of a bag or MCAP file, if several could be meant: color=/a,depth=/b; "
                     "also labels, info (CameraInfo), truth");
  command.add_option("--tour", tour, "scene: tour (YAML), or the name of a shipped one");
  command.add_option("--robot", robot, "scene: robot (YAML), or the name of a shipped one")
      ->default_str(kUsualRobot);
  command.add_option(
      "--level", level,
      "scene: sensor level (YAML), or the name of a shipped one (default: no noise)");
  frame.add_to(command);
  command.add_option("--seed", seed, "Seed of RANSAC and of a scene's noise")->check(seed_number());
}

std::filesystem::path SourceOptions::robot_file() const {
  return find_shipped(robot.empty() ? kUsualRobot : robot, Shipped::kRobot);
}

void SourceOptions::check() const {
  if (is_scene()) {
    if (!classes.empty())
      throw InputError("--classes is for recordings, but the source is a scene");
    if (!topics.empty()) throw InputError("--topics is for recordings, but the source is a scene");
    return;
  }
  const auto refuse = [&](const std::string& option) {
    throw InputError(fmt::format("{}: is for scene:FILE, but the source is '{}'", option, source));
  };
  for (const auto& [name, value] :
       {std::pair("--tour", &tour), {"--robot", &robot}, {"--level", &level}})
    if (!value->empty()) refuse(fmt::format("{} {}", name, *value));
  if (frame.up) refuse("--up");
  if (frame.floor_z_m) refuse("--floor-z");
}

std::string nothing_mapped(const std::string& source, const Sequence& frames, std::size_t first,
                           std::size_t offered) {
  std::string text = fmt::format(
      "{}: nothing could be mapped: none of {} showed 100 keypoints with depth to start with",
      source, counted(offered, "frame"));
  if (offered == 0) return text;
  std::vector<double> depths_m;
  try {
    const RgbdFrame frame = frames.frame(first, RandomStream());
    for (const float depth_m : frame.depth_m)
      if (depth_m > 0) depths_m.push_back(depth_m);
  } catch (const InputError&) {  // already reported when the frame was skipped
    return text;
  }
  if (depths_m.empty()) return text + " (the first image has no depth)";
  return text +
         fmt::format(" (median depth of the first image: {:.3g} m)", median(std::move(depths_m)));
}

Source open_source(const SourceOptions& options) {
  const std::string& source = options.source;
  if (options.is_scene()) {
    if (options.tour.empty()) throw InputError(fmt::format("source '{}' needs --tour", source));
    std::vector<std::string> notes;
    auto frames =
        open_scene({.scene = find_scene(source.substr(kSceneSource.size())),
                    .tour = find_shipped(options.tour, Shipped::kTour),
                    .robot = options.robot_file(),
                    .level = find_shipped(options.level, Shipped::kLevel),
                    .seed = options.seed,
                    .frame = options.frame.frame(),
                    .light = [](Scene& scene) { light_from_cache(scene, 2, usual_cache()); }},
                   &notes);
    return {settings_beside(options, *frames, notes), std::move(frames)};
  }
  Settings settings;
  const RecordingConfig config = with_settings({.calibration = options.settings,
                                                .classes = options.classes,
                                                .labels = options.labels,
                                                .topics = options.topics},
                                               &settings);
  OpenedRecording opened = open_sequence(source, config);
  try {
    require_undistortable(opened.sequence->camera());
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", source, error.what()));
  }
  if (!settings.has_camera)
    return {settings_beside(options, *opened.sequence, opened.notes), std::move(opened.sequence)};
  settings.notes.insert(settings.notes.end(), opened.notes.begin(), opened.notes.end());
  return {std::move(settings), std::move(opened.sequence)};
}

}  // namespace mh::cli
