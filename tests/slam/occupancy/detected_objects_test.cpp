// SPDX-License-Identifier: Apache-2.0
#include "slam/occupancy/detected_objects.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "slam/occupancy/objects.hpp"
#include "tests/slam/occupancy/made_map.hpp"

namespace mh {
namespace {

using Eigen::Vector3i;

/// A view of two chairs that touch, 9 voxels wide each: `numbers` gives the detection of each third
/// of each chair, from left to right; 0 = not seen.
VoxelView chairs(const std::array<std::uint8_t, 6>& numbers, ClassId class_id = kChair) {
  MadeMap made;
  for (int third = 0; third < 6; ++third)
    if (const std::uint8_t number = numbers[static_cast<std::size_t>(third)]; number != 0)
      made.box({3 * third, 0, 0}, {3 * third + 2, 8, 16}, class_id, number);
  return made.view();
}

/// The extents along x, in voxels, of the objects found after these views.
std::vector<std::pair<int, int>> found_after(
    const std::vector<std::array<std::uint8_t, 6>>& views) {
  VoxelMap map(0.05);
  DetectionAssociation association;
  for (const auto& numbers : views) {
    const VoxelView view = chairs(numbers);
    map.replace(nullptr, &view);
    association.add(view);
  }
  map.set_detected(association.objects(map));
  std::vector<std::pair<int, int>> boxes;
  for (const MapObject& object : find_objects(map))
    boxes.emplace_back(std::lround(object.min_m.x() / 0.05), std::lround(object.max_m.x() / 0.05));
  std::ranges::sort(boxes);
  return boxes;
}

using Boxes = std::vector<std::pair<int, int>>;
const Boxes kOne = {{0, 18}}, kTwo = {{0, 9}, {9, 18}};

TEST(DetectionAssociation, WhatViewsShowApartIsTwo) {
  EXPECT_EQ(found_after({{1, 1, 1, 1, 1, 1}}), kOne);
  EXPECT_EQ(found_after({{1, 1, 1, 2, 2, 2}}), kTwo);
}

TEST(DetectionAssociation, NumbersMeanNothingBeyondTheirView) {
  EXPECT_EQ(found_after({{1, 1, 1, 2, 2, 2}, {2, 2, 2, 1, 1, 1}}), kTwo);
  EXPECT_EQ(found_after({{1, 1, 1, 2, 2, 2}, {7, 7, 7, 7, 9, 9}, {3, 3, 3, 5, 5, 5}}), kTwo);
}

TEST(DetectionAssociation, MostViewsDecide) {
  EXPECT_EQ(found_after({{1, 1, 1, 2, 2, 2}, {3, 3, 3, 3, 3, 3}}), kOne);  // a tie
  EXPECT_EQ(found_after({{1, 1, 1, 2, 2, 2}, {3, 3, 3, 3, 3, 3}, {7, 7, 7, 9, 9, 9}}), kTwo);
}

TEST(DetectionAssociation, WhatBeganAsOneComesApart) {
  EXPECT_EQ(found_after({{1, 1, 1, 1, 1, 1}, {1, 1, 1, 2, 2, 2}, {1, 1, 1, 2, 2, 2}}), kTwo);
  // A box extends over the first third of the other chair.
  EXPECT_EQ(found_after({{1, 1, 1, 1, 0, 0},
                         {0, 0, 0, 1, 1, 1},
                         {1, 1, 1, 2, 2, 2},
                         {1, 1, 1, 2, 2, 2},
                         {1, 1, 1, 2, 2, 2}}),
            kTwo);
}

TEST(DetectionAssociation, PartsThatNoViewShowsApartAreOne) {
  EXPECT_EQ(found_after({{1, 1, 0, 0, 0, 0}, {0, 0, 0, 0, 1, 1}, {0, 0, 1, 1, 0, 0}}), kOne);
  EXPECT_EQ(found_after({{1, 0, 0, 0, 0, 0},
                         {0, 0, 1, 0, 0, 0},
                         {1, 1, 1, 0, 0, 0},
                         {1, 1, 1, 2, 2, 2},
                         {0, 0, 1, 2, 0, 0}}),
            kTwo);
}

TEST(DetectionAssociation, AVoxelIsOfTheObjectThatMostViewsGiveItTo) {
  // In one of three views, the border between the chairs is off by a third of a chair.
  EXPECT_EQ(found_after({{1, 1, 1, 2, 2, 2}, {1, 1, 1, 1, 2, 2}, {1, 1, 1, 2, 2, 2}}), kTwo);
}

TEST(DetectionAssociation, ClassesAreApartByThemselves) {
  MadeMap made;
  made.box({0, 0, 0}, {8, 8, 16}, kChair, 1);
  made.box({9, 0, 0}, {17, 8, 16}, kTable, 1);
  const VoxelMap map = made.map();
  DetectionAssociation association;
  association.add(made.view());
  const DetectedObjects objects = association.objects(map);
  EXPECT_NE(objects.at({0, 0, 0}), objects.at({9, 0, 0}));
  EXPECT_TRUE(objects.apart().empty());
  EXPECT_EQ(objects.entries().size(), 2u * 9 * 9 * 17);
  EXPECT_EQ(objects.at({-1, 0, 0}), 0);
}

TEST(DetectionAssociation, AnObjectApartIsNoFragmentOfALargerOne) {
  MadeMap made;
  made.box({0, 0, 0}, {20, 8, 16}, kChair, 1);
  made.box({22, 0, 0}, {25, 4, 4}, kChair, 2);
  VoxelMap map = made.map();
  EXPECT_EQ(find_objects(map).size(), 1u);
  DetectionAssociation association;
  association.add(made.view());
  map.set_detected(association.objects(map));
  EXPECT_EQ(find_objects(map).size(), 2u);
}

TEST(DetectedObjects, PairsAreFoundEitherWay) {
  const DetectedObjects objects({{{4, 5, 6}, 2}, {{1, 2, 3}, 1}}, {{1, 2}});
  EXPECT_TRUE(objects.are_apart(1, 2));
  EXPECT_TRUE(objects.are_apart(2, 1));
  EXPECT_FALSE(objects.are_apart(1, 3));
  EXPECT_EQ(objects.entries().front().object, 1);  // ordered by place
}

}  // namespace
}  // namespace mh
