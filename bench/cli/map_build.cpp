// SPDX-License-Identifier: Apache-2.0
// `modelhouse map build`: voxels, grid, costs and objects from a sequence's depth at known poses.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/progress.hpp"
#include "bench/cli/sequence_source.hpp"
#include "bench/lab/depth_comparison.hpp"
#include "bench/run/maps/laser_scans.hpp"
#include "bench/run/maps/map_images.hpp"
#include "bench/run/maps/map_score.hpp"
#include "bench/run/maps/map_study.hpp"
#include "robots/model/robot.hpp"
#include "scenes/load.hpp"
#include "scenes/recordings/images/write_image.hpp"
#include "sim/render/renderer.hpp"
#include "sim/simulation/travel.hpp"
#include "slam/core/interpolate.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/files/map_file.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/occupancy/cost_map.hpp"
#include "slam/occupancy/floor_frame.hpp"
#include "slam/occupancy/obstacle_grid.hpp"
#include "slam/occupancy/occupancy_mapper.hpp"
#include "slam/pipeline/slam.hpp"

namespace mh::cli {
namespace {

namespace fs = std::filesystem;

struct MapBuildArguments : SourceOptions {
  std::string vocabulary = "vocabulary", out, map, poses;
  double resolution_m = 0.05, height_m = 1.21;
  std::size_t frames = SIZE_MAX, every = 1;
  bool plain = false, score = false, lasers = false;
};

/// Poses of the frames whose depth is used, in the frame of their first camera.
struct Posed {
  Trajectory poses;
  std::vector<MapPoint> landmarks;  ///< of the SLAM map; empty if there is none
};

Posed posed_by(const SlamState& state) {
  Posed posed;
  for (const Keyframe& keyframe : state.map.keyframes())
    if (!keyframe.erased)
      posed.poses.push_back({keyframe.stamp_ns, keyframe.camera_from_world.inverse()});
  std::ranges::sort(posed.poses, {}, &TimedPose::stamp_ns);
  for (const Landmark& landmark : state.map.landmarks())
    if (!landmark.erased) posed.landmarks.push_back({landmark.position_in_world, landmark.label});
  return posed;
}

/// Maps the sequence as a live feed.
/// @param keep  receives the frame of each keyframe
Posed run_slam(const MapBuildArguments& options, const Source& source,
               const std::shared_ptr<const Vocabulary>& vocabulary,
               const std::function<void(const RgbdFrame&)>& keep) {
  SlamConfig config = source.settings.slam;
  if (options.plain) config.semantics = config.semantics.neutralized();
  SlamState state = make_slam(source.frames->camera(), config, vocabulary);
  Progress progress("map");
  const std::size_t end = std::min(options.frames, source.frames->size());
  for (std::size_t i = 0; i < end; ++i) {
    const RandomStream stream = RandomStream(options.seed).fork(i);
    const RgbdFrame frame = source.frames->frame(i, stream);
    if (state.last_stamp_ns && frame.stamp_ns <= *state.last_stamp_ns) continue;
    const StepReport report = step(state, frame, stream.fork(1));
    if (report.keyframe_added) keep(frame);
    progress.share(static_cast<double>(i + 1) / static_cast<double>(end),
                   counted(state.map.keyframe_count(), "keyframe"));
  }
  progress.end();
  if (state.map.empty()) throw InputError(nothing_mapped(options.source, *source.frames, 0, end));
  return posed_by(state);
}

/// Poses of the frames, interpolated from a trajectory whose stamps may differ from those of the
/// frames, as with motion capture.
Trajectory poses_of_frames(const Sequence& frames, const Trajectory& trajectory) {
  Trajectory poses;
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (const auto pose = interpolated_pose(trajectory, frames.stamp_ns(i), kMaxTruthGap_ns))
      poses.push_back({frames.stamp_ns(i), *pose});
  return poses;
}

/// Keeps the frames of the sequence whose stamps have a known pose. @returns their poses
Trajectory keep_posed(const MapBuildArguments& options, const Source& source,
                      const Trajectory& poses, const std::function<void(const RgbdFrame&)>& keep) {
  Trajectory kept;
  std::size_t met = 0;
  auto pose = poses.begin();
  for (std::size_t i = 0; i < std::min(options.frames, source.frames->size()); ++i) {
    const Stamp stamp_ns = source.frames->stamp_ns(i);
    while (pose != poses.end() && pose->stamp_ns < stamp_ns) ++pose;
    if (pose == poses.end()) break;
    if (pose->stamp_ns != stamp_ns || met++ % options.every != 0) continue;
    keep(source.frames->frame(i, RandomStream(options.seed).fork(i)));
    kept.push_back(*pose);
  }
  if (met == 0)
    throw InputError(fmt::format("{}: has no frame at the time of a pose of {}", options.source,
                                 options.map.empty() ? options.poses : options.map));
  return kept;
}

/// Transform from the mapped poses' frame to the map's frame. The map's frame is that of the scene
/// if there is one, since a robot in a scene knows the pose of its dock; otherwise it is that of
/// the floor. nullopt if no floor was seen.
std::optional<SE3> find_map_frame(const MapBuildArguments& options, const Source& source,
                                  const OccupancyMapper& mapper, const Trajectory& poses) {
  if (const Trajectory* truth = source.frames->truth(); options.is_scene() && truth != nullptr)
    for (const TimedPose& pose : poses)
      if (const TimedPose* known = pose_at(*truth, pose.stamp_ns))
        return known->world_from_camera * pose.world_from_camera.inverse();
  const auto floor = floor_of(mapper, poses);
  if (!floor) return std::nullopt;
  const SE3 first = floor->floor_from_world * poses.front().world_from_camera;
  fmt::print(stderr,
             "map: floor found by {}, {}, median distance {:.3f} m, {:.2f} m below the first "
             "camera\n",
             floor->by_labels ? "labels" : "geometry", counted(floor->points, "point"),
             floor->spread_m, first.translation().z());
  return floor->floor_from_world;
}

/// The keyframes of the source, from SLAM or at given poses. The mapper keeps their depth.
struct Keyframes {
  Posed posed;
  std::size_t kept = 0;
};

Keyframes keep_keyframes(const MapBuildArguments& options, const Source& source,
                         OccupancyMapper& mapper) {
  Keyframes keyframes;
  bool any_depth = false;
  const auto keep = [&](const RgbdFrame& frame) {
    mapper.keep(frame);
    ++keyframes.kept;
    any_depth = any_depth || std::ranges::any_of(frame.depth_m, [](float z) { return z > 0; });
  };
  if (!options.poses.empty()) {
    std::vector<std::string> notes;
    const Trajectory known =
        poses_of_frames(*source.frames, read_trajectory(options.poses, &notes));
    for (const std::string& note : notes) fmt::print(stderr, "map: warning: {}\n", note);
    keyframes.posed.poses = keep_posed(options, source, known, keep);
  } else {
    const auto vocabulary =
        std::make_shared<const Vocabulary>(Vocabulary::load(options.vocabulary));
    if (options.map.empty()) {
      keyframes.posed = run_slam(options, source, vocabulary, keep);
    } else {
      const SlamState state = load_slam(options.map, vocabulary);
      keyframes.posed = posed_by(state);
      DepthComparison comparison(state.map, source.frames->camera());
      keyframes.posed.poses =
          keep_posed(options, source, keyframes.posed.poses, [&](const RgbdFrame& frame) {
            keep(frame);
            comparison.add(frame);
          });
      comparison.require_same(options.map, options.source);
    }
  }
  if (!any_depth)
    throw InputError(fmt::format("{}: none of {} has depth: space cannot be mapped without it",
                                 options.source, counted(keyframes.kept, "keyframe")));
  return keyframes;
}

/// A scene to be mapped, with its robot's lasers if they are requested.
struct MappedScene {
  Scene scene;
  std::optional<SceneLasers> lasers;
};

std::unique_ptr<const MappedScene> load_mapped_scene(const MapBuildArguments& options) {
  if (!options.is_scene()) return nullptr;
  const fs::path file = find_scene(options.source.substr(kSceneSource.size()));
  auto mapped =
      std::make_unique<MappedScene>(load_scene(file, nullptr, options.frame.frame()), std::nullopt);
  if (options.lasers) mapped->lasers.emplace(mapped->scene, load_robot(options.robot_file()));
  return mapped;
}

/// Computes what is mapped over the floor: grid, costs, objects.
/// @param poses  the keyframes' poses, in the map's frame
MapStudy study_floor(const MapBuildArguments& options, const Source& source,
                     const MappedScene* mapped, const VoxelMap& map, const Trajectory& poses) {
  std::optional<ScanGrid> scans;
  if (mapped != nullptr && mapped->lasers)
    scans = mapped->lasers->scans(poses, *source.frames->truth(), options.resolution_m);
  // The origin of a recording's map frame is on the floor.
  const double floor_z_m = mapped != nullptr ? mapped->scene.floor.middle_m.z() : 0;
  MapStudy study = study_of(map, {.floor_z_m = floor_z_m, .robot_height_m = options.height_m},
                            scans ? &*scans : nullptr);
  if (study.grid.cells.empty())
    fmt::print(stderr,
               "map: warning: the grid is empty: nothing was seen from {:g} to {:g} m above the "
               "floor\n",
               ObstacleGridConfig{}.ground_m, options.height_m);
  return study;
}

MapScores score(const MapBuildArguments& options, const Trajectory& truth,
                const MappedScene& mapped, const OccupancyMapper& mapper, const MapStudy& study) {
  return score_map(mapped.scene, mapper, truth, study,
                   {.resolution_m = options.resolution_m,
                    .floor_z_m = mapped.scene.floor.middle_m.z(),
                    .robot_height_m = options.height_m},
                   mapped.lasers ? &*mapped.lasers : nullptr);
}

/// Removes the files of an earlier build from the folder, since this build may write fewer.
void remove_earlier(const fs::path& folder) {
  for (const char* name : kMapFiles) fs::remove(folder / name);
}

void check(const MapBuildArguments& options) {
  options.check();
  if (!options.map.empty() && !options.poses.empty())
    throw InputError("--map and --poses: give only one, which says where the frames are");
  if (options.every != 1 && options.map.empty() && options.poses.empty())
    throw InputError("--every: is for --poses and --map: SLAM chooses its keyframes itself");
  if (options.score && !options.is_scene())
    throw InputError("--score needs the exact mesh: the source must be scene:FILE");
  if (options.lasers && !(options.is_scene() && is_driven(options.tour)))
    throw InputError(
        "--lasers are a robot's: the source must be scene:FILE, with a tour that it drives");
}

void run(MapBuildArguments options) {
  check(options);
  resolve(options.vocabulary, Shipped::kVocabulary);
  resolve(options.settings, Shipped::kSettings);
  const OutputFolder folder(options.out, "map build", {kMapFiles.begin(), kMapFiles.end()});
  const ReadScope reading;
  const Source source = open_source(options);
  const auto mapped = load_mapped_scene(options);
  OccupancyMapper mapper(source.frames->camera(),
                         {.depth = {.resolution_m = options.resolution_m}});
  auto [posed, kept] = keep_keyframes(options, source, mapper);
  const std::optional<SE3> frame = find_map_frame(options, source, mapper, posed.poses);
  const SE3 map_from_world = frame.value_or(SE3());
  mapper.update(posed.poses, map_from_world);
  mapper.associate_detections();
  const std::string built =
      fmt::format("{}, {} ({:.1f} MB as an octree)", counted(kept, "keyframe"),
                  counted(mapper.map().voxel_count(), "voxel"),
                  static_cast<double>(mapper.map().memory_bytes()) * 1e-6);
  if (!frame) {
    require_unchanged(reading.record());
    fmt::print(
        stderr,
        "map: warning: no floor was found under the camera's path: there is no grid, and the "
        "octree is in the frame of the poses\n");
    VoxelMap map = std::move(mapper).take_map();
    map.set_on_floor(false);
    remove_earlier(options.out);
    write_octree(options.out, map);
    fmt::print("{}\n", built);
    return;
  }
  for (TimedPose& pose : posed.poses)
    pose.world_from_camera = map_from_world * pose.world_from_camera;
  for (MapPoint& landmark : posed.landmarks) landmark.point_m = map_from_world * landmark.point_m;
  const MapStudy study = study_floor(options, source, mapped.get(), mapper.map(), posed.poses);
  if (posed.landmarks.empty()) posed.landmarks = points_of(mapper.map());
  const auto classes = draw_classes_over(study.grid, posed.landmarks);
  std::optional<MapScores> scores;
  if (options.score) scores = score(options, *source.frames->truth(), *mapped, mapper, study);
  const fs::path out = options.out;
  require_unchanged(reading.record());
  remove_earlier(out);  // everything that replaces these files is computed by now
  write_map_files(out, mapper.map(), study);
  write_image(out / "grid_classes.png", classes);
  fmt::print("{}, grid of {} x {} cells, {}\n", built, study.grid.cells.width(),
             study.grid.cells.height(), counted(study.objects.size(), "object"));
  if (!scores) return;
  write_atomically(out / "score.json", scores_json(*scores));
  write_image(out / "grid_against_truth.png", draw_against_truth(study.grid, scores->plan));
  fmt::print("{}", scores_text(*scores));
}

}  // namespace

void add_map_build(CLI::App& map) {
  auto options = std::make_shared<MapBuildArguments>();
  CLI::App* command = map.add_subcommand(
      "build",
      "Builds an octree, grid, costs and objects from the depth of a sequence's keyframes.");
  options->add_to(*command);
  command->add_option("--out", options->out, "Folder for the results")->required();
  command->add_option("--map", options->map,
                      "Saved map (slam --save-map) of this sequence, which gives its keyframes' "
                      "poses (default: runs SLAM)");
  command->add_option("--poses", options->poses,
                      "Trajectory of this sequence instead of a map, TUM text or EuRoC CSV; "
                      "between its stamps, poses are interpolated over at most 0.05 s");
  command
      ->add_option("--every", options->every,
                   "With --poses or --map: only every n-th frame that has a pose")
      ->check(CLI::Range(1, 1000000));
  command->add_option("--vocabulary", options->vocabulary,
                      "Vocabulary file, or the name of the shipped one");
  command->add_option("--resolution", options->resolution_m, "Side of a voxel, m")
      ->check(number_between(0.016, 0.5));
  command
      ->add_option("--height", options->height_m,
                   "Height of the robot, m: anything higher is no obstacle")
      ->check(number_between(0.15, 10.0));
  command->add_option("--frames", options->frames, "At most this many frames")
      ->default_str("all")
      ->check(CLI::Range(1, 100000000));
  command->add_flag("--plain", options->plain, "SLAM without semantics");
  command->add_flag("--lasers", options->lasers,
                    "scene: adds what the robot's lasers see of the floor to the grid");
  command->add_flag(
      "--score", options->score,
      "scene: scores against the exact mesh, with the given poses and with the true ones");
  command->footer("Example:\n  modelhouse map build out/sequence --out out/map");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
