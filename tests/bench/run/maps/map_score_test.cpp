// SPDX-License-Identifier: Apache-2.0
#include "bench/run/maps/map_score.hpp"

#include <algorithm>
#include <initializer_list>
#include <numbers>

#include <gtest/gtest.h>

#include "bench/run/maps/map_study.hpp"
#include "sim/render/renderer.hpp"
#include "tests/slam/pipeline/feature_world.hpp"

namespace mh {
namespace {

using Eigen::Vector3d;

Instance instance(const char* name, ClassId class_id, const Vector3d& low, const Vector3d& high) {
  Instance made;
  made.name = name;
  made.class_id = class_id;
  made.min_m = low.cast<float>();
  made.max_m = high.cast<float>();
  return made;
}

MapObject found(ClassId class_id, const Vector3d& low, const Vector3d& high) {
  return {.name = "",
          .class_id = class_id,
          .center_m = 0.5 * (low + high),
          .min_m = low,
          .max_m = high};
}

TEST(ScoreObjects, EachTrueObjectIsFoundOnceAndEachFoundOneFindsOne) {
  Scene scene;
  scene.instances = {instance("chair", 5, {0, 0, 0}, {0.5, 0.5, 1}),
                     instance("other chair", 5, {0.6, 0, 0}, {1.1, 0.5, 1}),
                     instance("table", 7, {2, 0, 0}, {3, 1, 0.7}),
                     instance("vase", 46, {2.4, 0.4, 0.7}, {2.6, 0.6, 1.08}),
                     instance("wall", 1, {0, 3, 0}, {5, 3.1, 2.5})};
  const std::vector<MapObject> objects = {
      found(5, {0, 0, 0}, {0.55, 0.5, 1}),               // the first chair
      found(5, {0.05, 0, 0}, {0.5, 0.5, 1}),             // the same chair, found again
      found(7, {2.4, 0, 0}, {3, 1, 0.7}),                // 0.2 m off
      found(46, {2.35, 0.35, 0.7}, {2.65, 0.65, 1.15}),  // larger than the true one
      found(7, {8, 0, 0}, {9, 1, 0.7}),                  // no such object exists
      found(7, {8, 0, 0}, {8.2, 0.2, 0.2}),              // too small to count
  };
  const ObjectScore score = score_objects(objects, scene);
  EXPECT_EQ(score.recall.good, 2u);
  EXPECT_EQ(score.recall.all, 3u) << "no vase below 0.4 m, no wall";
  EXPECT_EQ(score.precision.good, 3u) << "chair, table and vase";
  EXPECT_EQ(score.precision.all, 5u);
}

// The plan has two rows of three cells; the grid is shifted by one cell and lacks the first column.
TEST(ScoreGrid, ComparesFreeCellsAtTheSamePlace) {
  const auto cells = [](int width, int height, std::initializer_list<std::int8_t> values) {
    Grid2d<std::int8_t> made(width, height);
    std::ranges::copy(values, made.begin());
    return made;
  };
  constexpr std::int8_t f = kFreeCell, o = kOccupiedCell, u = kUnknownCell;
  const OccupancyGrid plan{
      .cells = cells(3, 2, {f, f, o, f, f, u}), .resolution_m = 1, .origin_m = {0, 0}};
  const OccupancyGrid grid{
      .cells = cells(2, 2, {f, f, u, f}), .resolution_m = 1, .origin_m = {1, 0}};
  const GridScore score = score_grid(grid, plan);
  EXPECT_EQ(score.iou.good, 1u) << "column 1 of row 0";
  EXPECT_EQ(score.iou.all, 6u) << "four of the plan, and column 2, where the plan has none";
  EXPECT_EQ(score.iou_seen.good, 1u);
  EXPECT_EQ(score.iou_seen.all, 3u);
}

// A closed box of 4 m, seen from its center.
TEST(ScoreMap, OfAMapAtTruePosesIsThatOfItsOwnFrames) {
  Scene scene;
  for (int i = 0; i < 8; ++i)
    scene.positions_m.emplace_back((i & 1) != 0 ? 4 : 0, (i & 2) != 0 ? 4 : 0,
                                   (i & 4) != 0 ? 2.4F : 0);
  scene.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                     {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
  scene.material_of.assign(12, 0);
  scene.class_of.assign(12, 1);
  scene.instance_of.assign(12, 1);
  scene.materials.resize(1);
  scene.instances = {instance("wall", 1, {0, 0, 0}, {4, 4, 2.4})};
  scene.instances[0].id = 1;
  const auto renderer = make_renderer("embree", scene, {});
  const Camera camera;
  OccupancyMapper mapper(camera);
  Trajectory poses;
  for (int i = -2; i <= 2; ++i) {  // one half of the box
    const SE3 pose = testing_support::FeatureWorld::pose(2, i * std::numbers::pi / 6);
    poses.push_back({i + 3, SE3(pose.rotation(), {2, 2, 1.2})});
    RenderedFrame seen = renderer->render(camera, poses.back().world_from_camera);
    mapper.keep({i + 3, std::move(seen.color), std::move(seen.depth_m), {}});
  }
  mapper.update(poses);
  const MapStudy study = study_of(mapper.map(), {.floor_z_m = 0, .robot_height_m = 1.21});
  const MapScores scores = score_map(scene, mapper, poses, study, {});
  EXPECT_EQ(scores.keyframes, 5u);
  // The mapper rounds poses to a fraction of a cell, so a wall may end up in the next cell.
  EXPECT_NEAR(scores.grid.iou.value(), scores.grid_true_poses.iou.value(), 0.08);
  EXPECT_NEAR(scores.grid.iou_seen.value(), scores.grid_true_poses.iou_seen.value(), 0.08);
  EXPECT_GT(scores.grid.iou_seen.value(), scores.grid.iou.value() + 0.2);
  EXPECT_NEAR(scores.voxels.occupied_precision.value(),
              scores.voxels_true_poses.occupied_precision.value(), 0.02);
  EXPECT_GT(scores.voxels.occupied_precision.value(), 0.95);
}

}  // namespace
}  // namespace mh
