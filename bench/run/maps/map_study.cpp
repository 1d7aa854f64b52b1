// SPDX-License-Identifier: Apache-2.0
#include "bench/run/maps/map_study.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sim/render/renderer.hpp"
#include "slam/io/files.hpp"
#include "slam/occupancy/cost_map.hpp"

namespace mh {
namespace {

using Eigen::Vector3d;

nlohmann::ordered_json share_json(const Share& share) {
  return {{"value", share.value()}, {"good", share.good}, {"of", share.all}};
}

nlohmann::ordered_json part_json(const VoxelScore& voxels, const GridScore& grid,
                                 const ObjectScore& objects) {
  nlohmann::ordered_json json = {{"occupied_precision", share_json(voxels.occupied_precision)},
                                 {"occupied_recall", share_json(voxels.occupied_recall)},
                                 {"free_precision", share_json(voxels.free_precision)},
                                 {"free_within_one_cell", share_json(voxels.free_within_one)},
                                 {"free_recall", share_json(voxels.free_recall)},
                                 {"grid_iou", share_json(grid.iou)},
                                 {"grid_iou_seen", share_json(grid.iou_seen)},
                                 {"object_recall", share_json(objects.recall)},
                                 {"object_precision", share_json(objects.precision)}};
  for (const TrueObject& o : objects.objects)
    json["objects"].push_back({{"name", o.name},
                               {"class", classes()[o.class_id].name},
                               {"center_m", {o.center_m.x(), o.center_m.y(), o.center_m.z()}},
                               {"size_m", {o.size_m.x(), o.size_m.y(), o.size_m.z()}},
                               {"found", o.found},
                               {"away_m", o.away_m}});
  return json;
}

}  // namespace

MapStudy study_of(const VoxelMap& map, const ObstacleGridConfig& config, const ScanGrid* scans) {
  MapStudy study{.grid = obstacle_grid(map, config), .objects = find_objects(map)};
  if (scans != nullptr) scans->add_to(study.grid);
  return study;
}

void write_octree(const std::filesystem::path& folder, const VoxelMap& map) {
  map.save_ot(folder / "map.ot");
  map.save_bt(folder / "map.bt");
}

void write_map_files(const std::filesystem::path& folder, const VoxelMap& map,
                     const MapStudy& study) {
  write_octree(folder, map);
  save_map_server(study.grid, folder / "grid");
  save_map_server(study.grid, folder / "grid_raw", GridMode::kRaw);
  save_cost_map(cost_map(study.grid), folder / "cost");
  write_atomically(folder / "objects.json", objects_json(study.objects, map.resolution_m()));
}

const TimedPose* pose_at(const Trajectory& trajectory, Stamp stamp_ns) {
  const auto pose = std::ranges::lower_bound(trajectory, stamp_ns, {}, &TimedPose::stamp_ns);
  return pose != trajectory.end() && pose->stamp_ns == stamp_ns ? &*pose : nullptr;
}

std::optional<FloorFrame> floor_of(const OccupancyMapper& mapper,
                                   const Trajectory& world_from_camera) {
  constexpr std::size_t kMostViews = 60;
  constexpr int kStep = 4;  // in pixels of the thinned depth
  std::vector<LabeledPoint> points;
  std::vector<SE3> cameras;
  const std::size_t every = std::max<std::size_t>(1, world_from_camera.size() / kMostViews);
  for (std::size_t i = 0; i < world_from_camera.size(); i += every) {
    const TimedPose& pose = world_from_camera[i];
    const Grid2d<float>* depth_m = mapper.depth_of(pose.stamp_ns);
    if (depth_m == nullptr) continue;
    const Grid2d<ClassId>& labels = mapper.labels_of(pose.stamp_ns)->classes;
    cameras.push_back(pose.world_from_camera);
    for (int y = 0; y < depth_m->height(); y += kStep)
      for (int x = 0; x < depth_m->width(); x += kStep) {
        const auto z = static_cast<double>((*depth_m)(x, y));
        if (!(z > 0) || z > 4.0) continue;
        points.push_back({pose.world_from_camera * mapper.thin_camera().unproject(x, y, z),
                          labels.empty() ? kVoid : labels(x, y)});
      }
  }
  return find_floor_frame(points, cameras);
}

MapScores score_map(const Scene& scene, const OccupancyMapper& mapper, const Trajectory& truth,
                    const MapStudy& study, const MapScoreConfig& config,
                    const SceneLasers* lasers) {
  const auto renderer = make_embree_renderer(scene);
  const DepthModel model{.resolution_m = config.resolution_m};
  MapScores scores;
  VoxelMap exact(config.resolution_m), true_poses(config.resolution_m);
  DetectionAssociation association;
  std::vector<Vector3d> seeds;
  Trajectory seen_from;
  for (const Stamp stamp_ns : mapper.stamps()) {
    const TimedPose* pose = pose_at(truth, stamp_ns);
    if (pose == nullptr) continue;
    const SE3& at = pose->world_from_camera;
    seeds.push_back(at.translation());
    seen_from.push_back(*pose);
    Grid2d<float> exact_m = renderer->render_depth(mapper.thin_camera(), at);
    const Grid2d<float>& sensed_m = *mapper.depth_of(stamp_ns);
    for (std::size_t i = 0; i < exact_m.size(); ++i)
      if (!(sensed_m.data()[i] > 0)) exact_m.data()[i] = 0;
    const VoxelView seen = look(exact_m, {}, mapper.thin_camera(), at, model);
    exact.replace(nullptr, &seen);
    const VoxelView told = look(*mapper.depth_of(stamp_ns), *mapper.labels_of(stamp_ns),
                                mapper.thin_camera(), at, model);
    true_poses.replace(nullptr, &told);
    association.add(told);
    ++scores.keyframes;
  }
  true_poses.set_detected(association.objects(true_poses));
  const TrueSpace space(scene, config.resolution_m, seeds);
  const ObstacleGridConfig band{.floor_z_m = config.floor_z_m,
                                .robot_height_m = config.robot_height_m};
  scores.plan = space.floor_plan(band.lowest_m(config.resolution_m),
                                 config.floor_z_m + config.robot_height_m, seeds);
  std::optional<ScanGrid> scans;
  if (lasers != nullptr) scans = lasers->scans(seen_from, truth, config.resolution_m);
  const MapStudy study_true = study_of(true_poses, band, scans ? &*scans : nullptr);
  scores.voxels = score_voxels(mapper.map(), exact, space);
  scores.voxels_true_poses = score_voxels(true_poses, exact, space);
  scores.grid = score_grid(study.grid, scores.plan);
  scores.grid_true_poses = score_grid(study_true.grid, scores.plan);
  scores.objects = score_objects(study.objects, scene);
  scores.objects_true_poses = score_objects(study_true.objects, scene);
  return scores;
}

std::string scores_json(const MapScores& scores) {
  const nlohmann::ordered_json json = {
      {"keyframes", scores.keyframes},
      {"map", part_json(scores.voxels, scores.grid, scores.objects)},
      {"true_poses",
       part_json(scores.voxels_true_poses, scores.grid_true_poses, scores.objects_true_poses)}};
  return json.dump(2) + "\n";
}

std::string scores_text(const MapScores& s) {
  std::string text = fmt::format("{:<40}{:>10}{:>12}\n", "", "map", "true poses");
  const auto row = [&](const char* name, const Share& a, const Share& b) {
    text += fmt::format("{:<40}{:>10.4f}{:>12.4f}\n", name, a.value(), b.value());
  };
  const VoxelScore &v = s.voxels, &t = s.voxels_true_poses;
  row("occupied: precision within one cell", v.occupied_precision, t.occupied_precision);
  row("occupied: recall within one cell", v.occupied_recall, t.occupied_recall);
  row("free: precision, exact cell", v.free_precision, t.free_precision);
  row("free: precision within one cell", v.free_within_one, t.free_within_one);
  row("free: recall, exact cell", v.free_recall, t.free_recall);
  row("grid: IoU with the floor plan", s.grid.iou, s.grid_true_poses.iou);
  row("grid: IoU where the map knows", s.grid.iou_seen, s.grid_true_poses.iou_seen);
  row("objects: recall within 0.25 m", s.objects.recall, s.objects_true_poses.recall);
  row("objects: precision", s.objects.precision, s.objects_true_poses.precision);
  return text;
}

}  // namespace mh
