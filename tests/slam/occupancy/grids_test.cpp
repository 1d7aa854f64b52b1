// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/occupancy/cost_map.hpp"
#include "slam/occupancy/map_image.hpp"
#include "slam/occupancy/obstacle_grid.hpp"
#include "slam/occupancy/voxel_view.hpp"
#include "tests/slam/occupancy/box_room.hpp"
#include "tests/slam/occupancy/made_map.hpp"

namespace mh {
namespace {

int count(const OccupancyGrid& grid, std::int8_t value) {
  return static_cast<int>(std::count(grid.cells.begin(), grid.cells.end(), value));
}

TEST(ObstacleGrid, ABoxRoomIsFreeAmidItsWalls) {
  const OccupancyGrid grid = obstacle_grid(mapped_room().map(), {.floor_z_m = 0.02});
  // The room measures 3.54 x 2.29 m and is surrounded by walls of one cell.
  EXPECT_EQ(grid.cells.width(), 72);
  EXPECT_EQ(grid.cells.height(), 47);
  const auto at = [&](double x, double y) {
    const auto cell = grid.cell_of({x, y});
    return cell ? grid.cells(cell->x(), cell->y()) : kUnknownCell;
  };
  EXPECT_EQ(at(0.5, 0.5), kFreeCell);
  EXPECT_EQ(at(2.02, 0.5), kOccupiedCell);
  EXPECT_EQ(at(0.5, -1.02), kOccupiedCell);
  EXPECT_GT(count(grid, kFreeCell), 0.95 * 70 * 45);
  EXPECT_FALSE(grid.cell_of({2.3, 0.0}));
}

// A table top is an obstacle although the robot's base fits under it; a lintel above the robot's
// head is not, and neither is something flat on the floor.
TEST(ObstacleGrid, CountsWhatIsBetweenGroundAndHead) {
  MadeMap made;
  for (int x = 0; x < 20; ++x)
    for (int z = 0; z < 40; ++z) made.free({x, 0, z});
  made.hit({3, 0, 14});  // 0.70 to 0.75 m
  made.hit({6, 0, 30});  // 1.50 m
  made.hit({9, 0, 1});   // 0.05 to 0.10 m
  made.hit({12, 0, 2});  // 0.10 to 0.15 m
  const VoxelMap map = made.map();
  const OccupancyGrid grid = obstacle_grid(map);
  EXPECT_EQ(grid.cells(3, 0), kOccupiedCell);
  EXPECT_EQ(grid.cells(6, 0), kFreeCell);
  EXPECT_EQ(grid.cells(9, 0), kFreeCell);
  EXPECT_EQ(grid.cells(12, 0), kOccupiedCell);
  EXPECT_EQ(count(grid, kFreeCell), 18);
  // With a floor at 0.05 m, the hit at 0.10 to 0.15 m is flat on the floor: only the table top
  // remains.
  EXPECT_EQ(count(obstacle_grid(map, {.floor_z_m = 0.05}), kOccupiedCell), 1);
  EXPECT_EQ(count(obstacle_grid(map, {.robot_height_m = 1.6}), kOccupiedCell), 3);
  EXPECT_THROW(obstacle_grid(map, {.robot_height_m = 0.05}), InputError);
  EXPECT_TRUE(obstacle_grid(VoxelMap(0.05)).cells.empty());
}

TEST(ObstacleGrid, LargeVoxelsThatHoldTheFloorAreNoObstacles) {
  for (const double side_m : {0.2, 0.25, 0.5}) {
    MadeMap made;
    for (int x = 0; x < 4; ++x) {
      made.hit({x, 0, 0});  // the floor and its noise
      made.free({x, 0, 1});
    }
    made.hit({2, 0, 1});
    const OccupancyGrid grid = obstacle_grid(made.map(side_m));
    EXPECT_EQ(count(grid, kFreeCell), 3) << side_m;
    EXPECT_EQ(grid.cells(2, 0), kOccupiedCell) << side_m;
  }
}

TEST(ObstacleGrid, WhatWasSeenOnlyAboveIsNotFree) {
  MadeMap made;
  for (int z = 10; z < 24; ++z) made.free({0, 0, z});  // from 0.5 m upward
  for (int z = 2; z < 24; ++z) made.free({1, 0, z});
  const OccupancyGrid grid = obstacle_grid(made.map());
  EXPECT_EQ(grid.cells(0, 0), kUnknownCell);
  EXPECT_EQ(grid.cells(1, 0), kFreeCell);
}

RangeScan four_ways(float range_m) {
  return {.first_angle_rad = 0,
          .angle_increment_rad = M_PI / 2,
          .min_range_m = 0.1,
          .max_range_m = 3.0,
          .ranges_m = {range_m, range_m, 0.0F, std::numeric_limits<float>::infinity()}};
}

TEST(ScanGrid, ALaserIsASecondSource) {
  ScanGrid scans;
  const SE3 pose(Eigen::Matrix3d::Identity(), {0.025, 0.025, 0.3});
  scans.add_scan(pose, four_ways(0.5F));
  OccupancyGrid grid{.cells = Grid2d<std::int8_t>(2, 1, kUnknownCell), .origin_m = {0.05, 0.0}};
  grid.cells(0, 0) = kOccupiedCell;  // a table top, above the laser
  scans.add_to(grid);
  const auto at = [&](double x, double y) {
    const auto cell = grid.cell_of({x, y});
    return cell ? grid.cells(cell->x(), cell->y()) : kUnknownCell;
  };
  EXPECT_EQ(at(0.525, 0.025), kOccupiedCell);
  EXPECT_EQ(at(0.025, 0.525), kOccupiedCell);
  EXPECT_EQ(at(0.125, 0.025), kFreeCell);
  EXPECT_EQ(at(0.025, 0.125), kFreeCell);
  EXPECT_EQ(at(0.075, 0.025), kOccupiedCell);  // unchanged
  EXPECT_EQ(at(0.125, 0.125), kUnknownCell);
  EXPECT_EQ(at(-0.1, 0.025), kUnknownCell);  // ranges of 0 and infinity give no information
  EXPECT_EQ(count(grid, kOccupiedCell), 3);

  OccupancyGrid empty;
  ScanGrid().add_to(empty);
  EXPECT_TRUE(empty.cells.empty());
  OccupancyGrid other{.cells = {}, .resolution_m = 0.1};
  EXPECT_THROW(scans.add_to(other), InputError);
}

// 8 hits of 0.85 and 17 misses of -0.4 cancel out: what may be an obstacle is not driven over.
TEST(ScanGrid, HitsAndMissesThatSumToZeroAreAnObstacle) {
  const SE3 pose(Eigen::Matrix3d::Identity(), {0.025, 0.025, 0.3});
  const auto ahead = [](float range_m) { return RangeScan{.ranges_m = {range_m}}; };
  const auto at_half_a_meter = [&](int hits, int misses) {
    ScanGrid scans;
    for (int i = 0; i < misses; ++i) scans.add_scan(pose, ahead(1.0F));
    for (int i = 0; i < hits; ++i) scans.add_scan(pose, ahead(0.5F));
    OccupancyGrid grid;
    scans.add_to(grid);
    const auto cell = grid.cell_of({0.525, 0.025});
    return grid.cells(cell->x(), cell->y());
  };
  EXPECT_EQ(kHitLogOdds * 8.0F + kMissLogOdds * 17.0F, 0.0F);
  EXPECT_EQ(at_half_a_meter(8, 17), kOccupiedCell);
  EXPECT_EQ(at_half_a_meter(8, 18), kFreeCell);
  EXPECT_EQ(at_half_a_meter(7, 17), kFreeCell);
}

TEST(SmoothedDepth, TakesNeighborsWithinTheNoiseOrTwoCentimeters) {
  Grid2d<float> depth_m(3, 1, 0.5F);
  const auto middle = [&](float left, float right) {
    depth_m(0, 0) = left, depth_m(2, 0) = right;
    return smoothed_depth(depth_m, 0)(1, 0);
  };
  EXPECT_FLOAT_EQ(middle(0.509F, 0.509F), (0.5F + 2 * 0.509F) / 3);
  EXPECT_FLOAT_EQ(middle(0.519F, 0.482F), (0.5F + 0.519F + 0.482F) / 3) << "a slant";
  EXPECT_FLOAT_EQ(middle(0.511F, 0.511F), 0.5F) << "both before it: an edge";
  EXPECT_EQ(middle(0.521F, 0.479F), 0) << "nothing near it: not kept";
}

// nav2_costmap_2d: inflation_layer.hpp, computeCost().
TEST(CostMap, CostsDecayAsNav2PublishesIt) {
  const CostMapConfig config{
      .inscribed_radius_m = 0.26, .inflation_radius_m = 1.0, .cost_scaling_factor = 3.0};
  EXPECT_EQ(cost_at_distance(0.0, config), 254);
  EXPECT_EQ(cost_at_distance(0.26, config), 253);
  EXPECT_EQ(cost_at_distance(0.30, config), static_cast<int>(252 * std::exp(-3.0 * 0.04)));
  EXPECT_EQ(cost_at_distance(1.0, config), static_cast<int>(252 * std::exp(-3.0 * 0.74)));
  EXPECT_EQ(cost_at_distance(1.01, config), 0);

  OccupancyGrid grid{.cells = Grid2d<std::int8_t>(61, 41, kFreeCell)};
  grid.cells(30, 20) = grid.cells(31, 20) = kOccupiedCell;
  grid.cells(33, 20) = grid.cells(60, 0) = kUnknownCell;
  const CostMap costs = cost_map(grid, config);
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 61; ++x) {
      const double away_m = 0.05 * std::min(std::hypot(x - 30, y - 20), std::hypot(x - 31, y - 20));
      const int expected = x == 60 && y == 0 ? 255 : cost_at_distance(away_m, config);
      EXPECT_EQ(costs.costs(x, y), expected)
          << x << " " << y;  // unknown (33, 20) is too close, so it gets a cost, too
    }
}

// inflation_layer.cpp: the radius is rounded up to whole cells, and cells within it get a cost.
TEST(CostMap, EndsAtWholeCells) {
  OccupancyGrid grid{.cells = Grid2d<std::int8_t>(61, 1, kFreeCell)};
  grid.cells(0, 0) = kOccupiedCell;
  for (const auto& [radius_m, cells] : {std::pair(0.55, 11), {0.53, 11}, {0.50, 10}, {0.51, 11}}) {
    const CostMap costs = cost_map(grid, {.inflation_radius_m = radius_m});
    EXPECT_GT(costs.costs(cells, 0), 0) << radius_m;
    EXPECT_EQ(costs.costs(cells + 1, 0), 0) << radius_m;
  }
}

// Costs with Nav2's defaults and Pepper's radius, in steps of 5 cm from the obstacle.
TEST(CostMap, CostsAndWhatIsPublishedOfThemAtStatedDistances) {
  OccupancyGrid grid{.cells = Grid2d<std::int8_t>(14, 1, kFreeCell)};
  grid.cells(0, 0) = kOccupiedCell;
  grid.cells(13, 0) = kUnknownCell;
  const CostMap costs = cost_map(grid);
  const std::vector<int> nav2{254, 253, 253, 253, 253, 253, 223, 192, 165, 142, 122, 105, 0, 255};
  EXPECT_EQ(std::vector<int>(costs.costs.begin(), costs.costs.end()), nav2);
  const std::vector<int> published{100, 99, 99, 99, 99, 99, 86, 74, 64, 55, 47, 41, 0, -1};
  const OccupancyGrid shown = as_published(costs);
  EXPECT_EQ(std::vector<int>(shown.cells.begin(), shown.cells.end()), published);
}

// costmap_2d_publisher.cpp: 1 to 252 become 1 to 98, truncated to integers.
TEST(CostMap, InflatedCostsArePublishedAsOneToNinetyEight) {
  const std::vector<std::pair<int, int>> known{{1, 1},    {2, 1},    {3, 1},    {4, 2},   {100, 39},
                                               {126, 49}, {200, 77}, {251, 97}, {252, 98}};
  for (const auto& [cost, published] : known) {
    CostMap costs{.costs = Grid2d<std::uint8_t>(1, 1, static_cast<std::uint8_t>(cost))};
    EXPECT_EQ(as_published(costs).cells(0, 0), published) << cost;
  }
}

TEST(CostMap, AWideRadiusOverTinyCellsIsCutAtTheGrid) {
  OccupancyGrid grid{.cells = Grid2d<std::int8_t>(3, 2, kFreeCell), .resolution_m = 1e-4};
  grid.cells(0, 0) = kOccupiedCell;
  const CostMap costs = cost_map(grid, {.inscribed_radius_m = 0.1, .inflation_radius_m = 100});
  EXPECT_EQ(costs.costs(2, 1), kInscribedCost);
}

TEST(CostMap, RefusesSettingsOutOfRange) {
  OccupancyGrid grid{.cells = Grid2d<std::int8_t>(3, 3, kFreeCell)};
  EXPECT_THROW(cost_map(grid, {.inscribed_radius_m = 0.6, .inflation_radius_m = 0.5}), InputError);
  EXPECT_THROW(cost_map(grid, {.cost_scaling_factor = -1}), InputError);
  for (const double resolution_m : {0.0, 0.9e-4, 101.0}) {
    grid.resolution_m = resolution_m;
    EXPECT_THROW(cost_map(grid), InputError) << resolution_m;
  }
}

TEST(CostMap, FilesKeepNav2sNumbers) {
  CostMap costs{.costs = Grid2d<std::uint8_t>(5, 1)};
  const std::array<std::uint8_t, 5> levels{0, 128, 253, 254, 255};
  std::copy(levels.begin(), levels.end(), costs.costs.begin());
  const std::string stem = testing::TempDir() + "costs";
  save_cost_map(costs, stem);
  EXPECT_EQ(load_cost_map(stem + ".yaml").costs, costs.costs);
  EXPECT_NE(read_file(stem + ".yaml").find("mode: raw\n"), std::string::npos);
  // costmap_2d_publisher.cpp: 1 + 97 (cost - 1) / 251.
  const OccupancyGrid published = as_published(costs);
  const std::array<std::int8_t, 5> expected{0, 50, 99, 100, -1};
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), published.cells.begin()));
  save_map_server(published, stem + "_published", GridMode::kRaw);
  EXPECT_EQ(load_map_server(stem + "_published.yaml").cells, published.cells);
  EXPECT_THROW(load_cost_map(stem + "_none.yaml"), InputError);
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
  // The origin is at the lower left pixel: the first one of the last row.
  EXPECT_EQ(read_file(stem + ".pgm"),
            std::string("P5\n3 2\n255\n") + "\xCD\xCD\xFE" + std::string(1, '\0') + "\xCD\xCD");
  // Every field that nav2_map_server requires or documents, by its name there.
  EXPECT_EQ(read_file(stem + ".yaml"),
            "# Written by modelhouse\nimage: map.v1.pgm\nmode: trinary\nresolution: 0.05\norigin: "
            "[-1.25, 0.1, 0]\n"
            "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  save_map_server(grid, stem, GridMode::kRaw);
  EXPECT_EQ(load_map_server(stem + ".yaml").cells, grid.cells);
  EXPECT_EQ(read_file(stem + ".pgm"),
            std::string("P5\n3 2\n255\n") + "\xFF\xFF" + std::string(1, '\0') + "\x64\xFF\xFF");
}

void expect_map_refused(const std::string& yaml, const std::string& message) {
  const std::string file = testing::TempDir() + "bad_map.yaml";
  write_atomically(file, yaml);
  try {
    load_map_server(file);
    ADD_FAILURE() << "was read: " << yaml;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
  }
}

TEST(MapServer, RefusesWhatItCannotRead) {
  const std::string pgm = testing::TempDir() + "bad_map.pgm";
  const auto yaml = [](const std::string& resolution, const std::string& origin,
                       const std::string& mode = "trinary") {
    return "image: bad_map.pgm\nmode: " + mode + "\nresolution: " + resolution +
           "\norigin: " + origin + "\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n";
  };
  const std::string good = yaml("0.05", "[0, 0, 0]");
  std::filesystem::remove(pgm);
  expect_map_refused(good, ".yaml:1: image: " + pgm + ": no such file");
  write_atomically(pgm, "P5\n3 2\n255\nab");
  expect_map_refused(good, "truncated");
  write_atomically(pgm, "P5\n65536 65536\n255\nab");  // declares 4 GB that the file does not have
  expect_map_refused(good, "truncated");
  write_atomically(pgm, "P5\n1 1\n255");
  expect_map_refused(good, "truncated");
  write_atomically(pgm, "P5\n# a comment\n1 2\n255\nab");
  expect_map_refused(yaml("0", "[0, 0, 0]"), "resolution");
  expect_map_refused(yaml("0.05", "[0, 0, 0]", "gray"), "'gray' is not supported");
  expect_map_refused(yaml("0.05", "[1e300, 0, 0]"), "farther than");
  expect_map_refused(
      "image: bad_map.pgm\nresolution: 1\norigin: [0, 0, 0]\nnegate: 0\n"
      "occupied_thresh: 0.1\nfree_thresh: 0.9\n",
      "free_thresh: 0.9 is above occupied_thresh, 0.1");
  write_atomically(testing::TempDir() + "bad_map.yaml", good);
  EXPECT_EQ(load_map_server(testing::TempDir() + "bad_map.yaml").cells.height(), 2);
  for (const char* empty : {"P5\n0 0\n255\n", "P5\n40 0\n255\n", "P5\n-1 2\n255\nab"}) {
    write_atomically(pgm, empty);
    expect_map_refused(good, "pixels, not 1 to 65536 each");
  }
  for (const auto& [image, message] : std::vector<std::pair<std::string, std::string>>{
           {"P6\n1 1\n255\nabc", "is not a PGM image (P5 or P2)"},
           {"P2\n2 1\n255\n7\n", "is truncated"},
           {"P2\n2 1\n255\n7 # 8\n", "is truncated"},
           {"P2\n2 1\n255\n7 8x", "pixel 2 is '8x', not a number"},
           {"P2\n2 1\n100\n7 101", "a pixel is 101, its maximum 100"},
           {"P2\n2 1\n0\n0 0", "a maximum of 1 to 65535"},
           {"P2\n2 1\n", "a maximum of 1 to 65535"},
           {"P5\n2 1\n65535\nabc", "is truncated"}}) {
    write_atomically(pgm, image);
    expect_map_refused(good, message);
  }
}

/// Writes a map with this image and additional keys, and loads it.
OccupancyGrid loaded(const std::string& image, const std::string& keys,
                     const ImageDecoder& decode = nullptr) {
  write_atomically(testing::TempDir() + "made.pgm", image);
  const std::string file = testing::TempDir() + "made.yaml";
  write_atomically(file, "image: made.pgm\nresolution: 0.5\nnegate: 0\n" + keys);
  return load_map_server(file, nullptr, decode);
}

std::vector<int> cells_of(const OccupancyGrid& grid) {
  return {grid.cells.begin(), grid.cells.end()};
}

TEST(MapServer, PgmMayBeTextOrOfAnotherMaximum) {
  const std::string keys = "origin: [0, 0, 0]\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
  const std::vector<int> expected{-1, 100, 0, 100};  // the lower row is first
  EXPECT_EQ(cells_of(loaded("P2\n# GIMP\n2 2\n255\n254 0 # a row\n205\n0\n", keys)), expected);
  EXPECT_EQ(cells_of(loaded("P2 2 2 100 100 0 80 0", keys)), expected);
  const std::string nul(1, '\0');
  EXPECT_EQ(cells_of(loaded("P5 2 2 65535\n\xFF\xFE" + nul + nul + "\xCD\xCD" + nul + nul, keys)),
            expected);
}

TEST(MapServer, ModeScaleKeepsWhatIsBetweenTheThresholds) {
  // nav2_map_server: 100 (p - free) / (occupied - free), rounded; p = 1 - level / 255.
  EXPECT_EQ(cells_of(loaded("P2 5 1 255 255 204 153 102 51",
                            "mode: scale\norigin: [0, 0, 0]\noccupied_thresh: 0.75\n"
                            "free_thresh: 0.25\n")),
            (std::vector<int>{0, 0, 30, 70, 100}));
}

TEST(MapServer, PixelsThatAreNotOpaqueAreUnknown) {
  const auto decode = [](const std::string& bytes) {
    EXPECT_EQ(bytes, "\x89PNG");
    GrayImage image{Grid2d<std::uint8_t>(2, 2, 255), {false, true, false, false}};
    image.levels(0, 1) = 0;
    return image;
  };
  const std::string keys = "origin: [0, 0, 0]\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
  EXPECT_EQ(cells_of(loaded("\x89PNG", keys, decode)), (std::vector<int>{100, 0, 0, -1}));
}

TEST(MapServer, ATurnedGridKeepsItsYawAndItsPlaces) {
  // By hand: 30 degrees, cells of 0.5 m. The center of cell (2, 1) is (1.25, 0.75) along the grid:
  // 1.25 cos - 0.75 sin = 0.7075, 1.25 sin + 0.75 cos = 1.2745 from the corner (10, -20).
  const OccupancyGrid grid =
      loaded("P2 3 2 255 254 254 0 254 254 254",
             "origin: [10, -20, 0.5235987755982988]\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  EXPECT_EQ(grid.cells(2, 1), kOccupiedCell);
  EXPECT_NEAR(grid.center_m(2, 1).x(), 10.7075, 1e-4);
  EXPECT_NEAR(grid.center_m(2, 1).y(), -18.7255, 1e-4);
  EXPECT_EQ(grid.cell_of({10.7075, -18.7255}), Eigen::Vector2i(2, 1));
  EXPECT_EQ(grid.cell_of({10.3, -19.7}), Eigen::Vector2i(0, 0));
  EXPECT_FALSE(grid.cell_of({11.4, -19.9})) << "inside of the unturned grid, outside of this one";
  const std::string stem = testing::TempDir() + "turned";
  save_map_server(grid, stem);
  EXPECT_EQ(load_map_server(stem + ".yaml").yaw_rad, grid.yaw_rad);
  const CostMap costs = cost_map(grid);
  save_cost_map(costs, stem);
  EXPECT_EQ(load_cost_map(stem + ".yaml").yaw_rad, grid.yaw_rad);
  EXPECT_EQ(as_published(costs).yaw_rad, grid.yaw_rad);
}

TEST(MapServer, ReadsWhatOthersWrite) {
  const std::string pgm = testing::TempDir() + "others.pgm", file = testing::TempDir() + "o.yaml";
  write_atomically(pgm, std::string("P5\n2 1\n255\n") + "\xFE" + std::string(1, '\0'));
  const auto cells = [&](const std::string& negate) {
    write_atomically(file,
                     "image: others.pgm\nmap_type: occupancy\nresolution: 1\n"
                     "origin: [0, 0, 0]\nnegate: " +
                         negate + "\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
    const OccupancyGrid grid = load_map_server(file);
    return std::pair(int{grid.cells(0, 0)}, int{grid.cells(1, 0)});
  };
  EXPECT_EQ(cells("false"), std::pair(0, 100));
  EXPECT_EQ(cells("true"), std::pair(100, 0));
  EXPECT_EQ(cells("True"), std::pair(100, 0));
  EXPECT_EQ(cells("1"), std::pair(100, 0));
  EXPECT_THROW(cells("yes"), InputError);
}

TEST(MapServer, LevelsOnAThresholdAreBeyondIt) {
  const std::string pgm = testing::TempDir() + "tie.pgm", file = testing::TempDir() + "tie.yaml";
  write_atomically(pgm, std::string("P5\n3 1\n255\n") + "\xFF\x80" + std::string(1, '\0'));
  write_atomically(file,
                   "image: tie.pgm\nresolution: 1\norigin: [0, 0, 0]\nnegate: 0\n"
                   "occupied_thresh: 1.0\nfree_thresh: 0.0\n");  // as in Nav2's depot_speed.yaml
  const OccupancyGrid grid = load_map_server(file);
  EXPECT_EQ(grid.cells(0, 0), kFreeCell);
  EXPECT_EQ(grid.cells(1, 0), kUnknownCell);
  EXPECT_EQ(grid.cells(2, 0), kOccupiedCell);
}

TEST(MapServer, DirtyFilesAreReadWithAWarning) {
  const std::string pgm = testing::TempDir() + "dirty.pgm",
                    file = testing::TempDir() + "dirty.yaml";
  const auto write = [&](const std::string& image, const std::string& more) {
    write_atomically(pgm, image);
    write_atomically(file,
                     "image: dirty.pgm\nresolution: 1\norigin: [0, 0, 0]\nnegate: 0\n"
                     "occupied_thresh: 0.65\nfree_thresh: 0.196\n" +
                         more);
  };
  const auto read = [&](std::vector<std::string> expected) {
    std::vector<std::string> warnings;
    const OccupancyGrid grid = load_map_server(file, &warnings);
    EXPECT_EQ(warnings.size(), expected.size());
    for (std::size_t i = 0; i < std::min(expected.size(), warnings.size()); ++i)
      EXPECT_NE(warnings[i].find(expected[i]), std::string::npos) << warnings[i];
    return std::pair(int{grid.cells(0, 0)}, int{grid.cells(1, 0)});
  };
  const std::string pixels = std::string("\xFE") + '\0';
  const std::pair<int, int> right{0, 100};
  write("P5\r\n2 1\r\n255\r\n" + pixels, "mode: Trinary\n");
  EXPECT_EQ(read({}), right);
  write("P5\n2 1\n255\n" + pixels + "\n", "");
  EXPECT_EQ(read({"1 byte after its 2 x 1 pixels is ignored"}), right);
  write("P5\n2 1\n255\n" + pixels, "mdoe: raw\n");
  EXPECT_EQ(
      read({"dirty.yaml:7: key 'mdoe' is not one of map_server's and is ignored; did you mean "
            "'mode'?"}),
      right);
  write("P5\n2 1\n255\n" + pixels, "");
  const auto turn = [&](const std::string& yaw) {
    write_atomically(file, "image: dirty.pgm\nresolution: 1\norigin: [0, 0, " + yaw +
                               "]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  };
  turn("-nan");  // written by map_saver if a mapper sent no valid quaternion
  EXPECT_EQ(read({"dirty.yaml:3: origin: its yaw '-nan' is taken as 0"}), right);
  turn("90");
  EXPECT_EQ(read({"its yaw of 90 is read in radians"}), right);
  write("P5\n2 1\n255\n" + pixels, "mode: raw\n");
  EXPECT_EQ(read({"1 cell is from 101 to 254"}), std::pair(-1, 0));
}

TEST(MapServer, NamesThatYamlWouldMisreadAreQuoted) {
  const OccupancyGrid grid{.cells = Grid2d<std::int8_t>(1, 1, kFreeCell)};
  const std::string stem = testing::TempDir() + "it's: odd #1";
  save_map_server(grid, stem);
  EXPECT_EQ(load_map_server(stem + ".yaml").cells, grid.cells);
}

TEST(MapServer, FilesOfOthersAreNotReplaced) {
  const std::string stem = testing::TempDir() + "replaceable";
  std::filesystem::remove(stem + ".pgm");
  std::filesystem::remove(stem + ".yaml");
  require_replaceable_map_image(stem);
  save_map_server({.cells = Grid2d<std::int8_t>(1, 1, kFreeCell)}, stem);
  require_replaceable_map_image(stem);
  write_atomically(stem + ".yaml", "image: replaceable.pgm\n");
  EXPECT_THROW(require_replaceable_map_image(stem), InputError);
  std::filesystem::remove(stem + ".yaml");  // an image of a user
  EXPECT_THROW(require_replaceable_map_image(stem), InputError);
  EXPECT_THROW(require_replaceable_map_image(testing::TempDir() + "folder/"), InputError);
  EXPECT_THROW(require_replaceable_map_image(""), InputError);
  EXPECT_THROW(require_replaceable_map_image(testing::TempDir() + "new.pgm"), InputError);
}

}  // namespace
}  // namespace mh
