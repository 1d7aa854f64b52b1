// SPDX-License-Identifier: Apache-2.0
#include "slam/occupancy/occupancy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include "slam/core/error.hpp"
#include "slam/core/files.hpp"

namespace mh {
namespace {

// A box room, seen from inside: every ray ends at the nearest of six planes.
// The planes stand clear of the borders of voxels.
const Eigen::Vector3d kRoomMin(-1.52, -1.02, 0.02), kRoomMax(2.02, 1.27, 2.52);
const Eigen::Vector3d kEye(0.01, 0.01, 0.51);

Camera small_camera() {
  Camera camera;
  camera.width_px = 160;
  camera.height_px = 120;
  camera.fx_px = camera.fy_px = 145.0;
  camera.cx_px = 79.5;
  camera.cy_px = 59.5;
  return camera;
}
const Camera kCamera = small_camera();

SE3 world_from_camera(double heading_rad) {
  Eigen::Matrix3d body_from_optical;
  body_from_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitZ()) * body_from_optical, kEye};
}

Grid2d<float> depth_of_room(const SE3& pose) {
  Grid2d<float> depth(kCamera.width_px, kCamera.height_px);
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x) {
      const Eigen::Vector3d ray = pose.rotation() * kCamera.unproject(x, y, 1.0);
      double z = std::numeric_limits<double>::infinity();
      for (int axis = 0; axis < 3; ++axis)
        if (ray[axis] != 0)
          z = std::min(z, ((ray[axis] > 0 ? kRoomMax : kRoomMin)[axis] - kEye[axis]) / ray[axis]);
      depth(x, y) = static_cast<float>(z);
    }
  return depth;
}

/// The room mapped by one look around.
OccupancyMapper mapped_room(double max_range_m = 4.0) {
  OccupancyMapper mapper({.max_range_m = max_range_m, .stride_px = 1});
  for (int i = 0; i < 16; ++i) {
    const SE3 pose = world_from_camera(i * M_PI / 8);
    mapper.insert(depth_of_room(pose), kCamera, pose);
  }
  return mapper;
}

int count(const OccupancyGrid& grid, std::int8_t value) {
  return static_cast<int>(std::count(grid.cells.begin(), grid.cells.end(), value));
}

TEST(OccupancyMapper, ABoxRoomIsFreeInsideAndOccupiedAtItsWalls) {
  const OccupancyGrid grid = mapped_room().project(0.3, 1.9);
  ASSERT_DOUBLE_EQ(grid.resolution_m, 0.05);
  int walls = 0;
  for (int y = 0; y < grid.cells.height(); ++y)
    for (int x = 0; x < grid.cells.width(); ++x) {
      const Eigen::Vector2d p = grid.center_m(x, y);
      const double inside = std::min(
          {p.x() - kRoomMin.x(), kRoomMax.x() - p.x(), p.y() - kRoomMin.y(), kRoomMax.y() - p.y()});
      // Walls fall into the voxel that they run through.
      if (inside > 0.051) {
        ASSERT_EQ(grid.cells(x, y), kFreeCell) << p.transpose();
      }
      if (inside < -0.051) {
        ASSERT_EQ(grid.cells(x, y), kUnknownCell) << p.transpose();
      }
      walls += grid.cells(x, y) == kOccupiedCell ? 1 : 0;
    }
  // 72 x 47 cells with walls all round; a corner may have gone unseen.
  EXPECT_NEAR(walls, 2 * 72 + 2 * 45, 4);
}

TEST(OccupancyMapper, BeyondTheRangeNothingIsSeen) {
  const OccupancyGrid grid = mapped_room(0.8).project(0.3, 1.9);
  EXPECT_EQ(count(grid, kOccupiedCell), 0);  // the nearest wall is 1 m away
  EXPECT_NEAR(count(grid, kFreeCell) * 0.05 * 0.05, M_PI * 0.8 * 0.8, 0.25);
}

TEST(OccupancyMapper, HeightsOutsideTheBandDoNotCount) {
  const OccupancyMapper mapper = mapped_room();
  const OccupancyGrid floor = mapper.project(-0.04, 0.04);
  EXPECT_GT(count(floor, kOccupiedCell), 500);
  EXPECT_TRUE(mapper.project(5.0, 6.0).cells.empty());
}

TEST(OccupancyMapper, ReloadedTreesAreEqual) {
  const OccupancyMapper mapper = mapped_room();
  const std::string file = testing::TempDir() + "occupancy_test.bt";
  mapper.save_bt(file);
  const OccupancyMapper reloaded = OccupancyMapper::load_bt(file);
  const OccupancyGrid a = mapper.project(0.3, 1.9), b = reloaded.project(0.3, 1.9);
  EXPECT_GT(mapper.leaf_count(), 1000U);
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(a.origin_m, b.origin_m);
  reloaded.save_bt(file + "2");
  EXPECT_EQ(read_file(file), read_file(file + "2"));
  EXPECT_THROW(mapper.save_bt("/no/such/folder/map.bt"), InputError);
  EXPECT_THROW(OccupancyMapper::load_bt("/no/such/map.bt"), InputError);
  const std::string whole = read_file(file);
  write_atomically(file, whole.substr(0, whole.size() / 2));
  EXPECT_THROW(OccupancyMapper::load_bt(file), InputError);
  write_atomically(file, "nonsense");
  EXPECT_THROW(OccupancyMapper::load_bt(file), InputError);
  const std::string head = "# Octomap OcTree binary file\nid OcTree\nsize 9\nres 0.1\ndata\n";
  write_atomically(file, head + std::string(2'000'000, '\xff'));  // children of children of ...
  EXPECT_THROW(OccupancyMapper::load_bt(file), InputError);
}

TEST(OccupancyMapper, OctoMapReadsTheFile) {
  const OccupancyMapper mapper = mapped_room();
  const std::string file = testing::TempDir() + "occupancy_octomap.bt";
  mapper.save_bt(file);
  octomap::OcTree tree(1.0);
  ASSERT_TRUE(tree.readBinary(file));
  EXPECT_EQ(tree.getResolution(), 0.05);
  EXPECT_EQ(tree.getNumLeafNodes(), OccupancyMapper::load_bt(file).leaf_count());
  const auto* here = tree.search(kEye.x(), kEye.y(), kEye.z());
  const auto* wall = tree.search(kRoomMax.x(), kEye.y(), kEye.z());
  ASSERT_TRUE(here != nullptr && wall != nullptr);
  EXPECT_FALSE(tree.isNodeOccupied(here));
  EXPECT_TRUE(tree.isNodeOccupied(wall));
}

/// Deeper and shallower than the range, from a moving eye, so that rays cross voxels in many ways.
TEST(OccupancyMapper, InsertsAsOctoMapDoes) {
  for (const double max_range_m : {0.9, 4.0}) {
    OccupancyMapper mapper({.max_range_m = max_range_m, .stride_px = 3});
    octomap::OcTree tree(0.05);
    for (int i = 0; i < 20; ++i) {
      const SE3 turned = world_from_camera(i * 0.7);
      const SE3 pose(turned.rotation(),
                     turned.translation() + Eigen::Vector3d(0.013 * i, -0.007 * i, 0.011 * i));
      const Grid2d<float> depth = depth_of_room(turned);
      mapper.insert(depth, kCamera, pose);
      octomap::Pointcloud points;
      for (int y = 1; y < depth.height(); y += 3)
        for (int x = 1; x < depth.width(); x += 3) {
          const Eigen::Vector3d p = pose * kCamera.unproject(x, y, depth(x, y));
          points.push_back(static_cast<float>(p.x()), static_cast<float>(p.y()),
                           static_cast<float>(p.z()));
        }
      const Eigen::Vector3d& eye = pose.translation();
      tree.insertPointCloud(
          points,
          {static_cast<float>(eye.x()), static_cast<float>(eye.y()), static_cast<float>(eye.z())},
          max_range_m, true, true);
    }
    ASSERT_GT(tree.getNumLeafNodes(), 5000U);
    EXPECT_EQ(mapper.leaf_count(), tree.getNumLeafNodes());
    tree.toMaxLikelihood();
    tree.prune();
    std::ostringstream expected, got;
    tree.writeBinaryData(expected);
    mapper.write_bt(got);
    EXPECT_TRUE(got.str().ends_with("data\n" + expected.str()));
  }
}

TEST(OccupancyMapper, AReloadedTreeTakesMore) {
  const std::string file = testing::TempDir() + "occupancy_more.bt";
  mapped_room().save_bt(file);
  OccupancyMapper reloaded = OccupancyMapper::load_bt(file);
  const SE3 pose = world_from_camera(0);
  // A thing close by in a room that was free there: its voxels alone may change, not the blocks
  // that they were part of.
  Grid2d<float> near(kCamera.width_px, kCamera.height_px, 0.0F);
  near(81, 61) = 0.5F;  // every second pixel is used
  for (int i = 0; i < 20; ++i) reloaded.insert(near, kCamera, pose);
  const OccupancyGrid before = mapped_room().project(0.3, 1.9), after = reloaded.project(0.3, 1.9);
  EXPECT_EQ(count(after, kOccupiedCell), count(before, kOccupiedCell) + 1);
  EXPECT_EQ(count(after, kUnknownCell), count(before, kUnknownCell));
}

TEST(OccupancyMapper, RepeatsBitForBit) {
  const std::string a = testing::TempDir() + "occupancy_a.bt",
                    b = testing::TempDir() + "occupancy_b.bt";
  mapped_room().save_bt(a);
  mapped_room().save_bt(b);
  EXPECT_EQ(read_file(a), read_file(b));
}

TEST(MapServer, RoundTripKeepsCellsAndPlace) {
  OccupancyGrid grid{.cells = Grid2d<std::int8_t>(3, 2, kUnknownCell),
                     .resolution_m = 0.05,
                     .origin_m = {-1.25, 0.1}};
  grid.cells(0, 0) = kOccupiedCell;
  grid.cells(2, 1) = kFreeCell;
  const std::string stem = testing::TempDir() + "map.v1";  // the dot is part of the name
  save_map_server(grid, stem);
  const OccupancyGrid back = load_map_server(stem + ".yaml");
  EXPECT_EQ(back.cells, grid.cells);
  EXPECT_EQ(back.origin_m, grid.origin_m);
  EXPECT_EQ(back.resolution_m, grid.resolution_m);
  // The origin is the lower left pixel: the first of the last row.
  const std::string image = read_file(stem + ".pgm");
  EXPECT_EQ(image,
            std::string("P5\n3 2\n255\n") + "\xCD\xCD\xFE" + std::string(1, '\0') + "\xCD\xCD");
}

TEST(MapServer, RefusesWhatItCannotRead) {
  const std::string stem = testing::TempDir() + "bad_map";
  const std::string rest =
      "resolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n";
  write_atomically(stem + ".yaml", "image: bad_map.pgm\n" + rest);
  write_atomically(stem + ".pgm", "P5\n3 2\n255\nab");
  EXPECT_THROW(load_map_server(stem + ".yaml"), InputError);
  write_atomically(stem + ".pgm", "P5\n# a comment\n1 2\n255\nab");
  EXPECT_EQ(load_map_server(stem + ".yaml").cells.height(), 2);
  write_atomically(stem + ".pgm", "P5\n65536 65536\n255\nab");  // 4 GB that are not there
  EXPECT_THROW(load_map_server(stem + ".yaml"), InputError);
  write_atomically(stem + ".pgm", "P5\n1 1\n255");
  EXPECT_THROW(load_map_server(stem + ".yaml"), InputError);
  write_atomically(stem + ".yaml", "image: bad_map.pgm\nmode: raw\n" + rest);
  EXPECT_THROW(load_map_server(stem + ".yaml"), InputError);
}

}  // namespace
}  // namespace mh
