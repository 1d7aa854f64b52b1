// SPDX-License-Identifier: Apache-2.0
#include "bench/report/drawing/slice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace mh {
namespace {

TEST(Slice, CutsATentIntoItsOutlineAtThatHeight) {
  // A tent 2 m long along y, 2 m wide and 1 m high: at height h each side is cut at |x| = 1 - h.
  Scene scene;
  scene.positions_m = {{-1, 0, 0}, {-1, 2, 0}, {0, 0, 1}, {0, 2, 1}, {1, 0, 0}, {1, 2, 0}};
  scene.triangles = {{0, 1, 2}, {1, 3, 2}, {4, 2, 5}, {5, 2, 3}};
  scene.class_of = {1, 1, 2, 2};
  const std::vector<SliceSegment> segments = slice(scene, 0.25);
  ASSERT_EQ(segments.size(), 4u);
  double length = 0;
  for (const SliceSegment& s : segments) {
    EXPECT_NEAR(std::abs(s.from_m.x()), 0.75, 1e-6);
    EXPECT_NEAR(std::abs(s.to_m.x()), 0.75, 1e-6);
    length += (s.from_m - s.to_m).norm();
  }
  EXPECT_NEAR(length, 4.0, 1e-6);
  EXPECT_EQ(segments[0].class_id, 1);
  EXPECT_TRUE(slice(scene, 1.5).empty());
}

// The surface |x| + |y| + |z| = 1, turned about its vertical axis by several angles, with its faces
// listed from each of their corners. At height h the cut is a square of side sqrt(2) (1 - |h|); at
// h = 0 the plane passes exactly through four of the corners, and at the tips nothing is left to
// cut.
TEST(Slice, OfAClosedSurfaceIsClosedAtAnyHeight) {
  for (const double turn : {0.0, 0.3, 0.5 * std::numbers::pi})
    for (std::uint32_t begin = 0; begin < 3; ++begin) {
      Scene scene;
      for (int k = 0; k < 4; ++k) {
        const double angle = turn + 0.5 * std::numbers::pi * k;
        scene.positions_m.emplace_back(std::cos(angle), std::sin(angle), 0);
      }
      scene.positions_m.emplace_back(0, 0, 1);
      scene.positions_m.emplace_back(0, 0, -1);
      for (std::uint32_t k = 0; k < 4; ++k)
        for (const std::uint32_t tip : {4U, 5U}) {
          const std::array<std::uint32_t, 3> face = {k, (k + 1) % 4, tip};
          scene.triangles.push_back({face[begin], face[(begin + 1) % 3], face[(begin + 2) % 3]});
          scene.class_of.push_back(1);
        }
      for (const double height : {-1.5, -1.0, -0.5, -0.25, 0.0, 0.25, 0.5, 1.0, 1.5}) {
        const std::vector<SliceSegment> segments = slice(scene, height);
        double length = 0;
        Eigen::Vector2d sum(0, 0);
        for (const SliceSegment& s : segments) {
          length += (s.from_m - s.to_m).norm();
          sum += s.from_m + s.to_m;
          for (const Eigen::Vector2d& end : {s.from_m, s.to_m}) {
            int ends_here = 0;
            for (const SliceSegment& other : segments)
              ends_here +=
                  ((other.from_m - end).norm() < 1e-6) + ((other.to_m - end).norm() < 1e-6);
            EXPECT_EQ(ends_here % 2, 0) << height << ": an open end";
          }
        }
        EXPECT_NEAR(length, 4 * std::numbers::sqrt2 * std::max(0.0, 1 - std::abs(height)), 1e-5)
            << height;
        EXPECT_LT(sum.norm(), 1e-5) << "not around the axis";
      }
    }
}

// A corner that lies in the plane counts as above it, no matter which corner is listed first.
TEST(Slice, ATriangleCutThroughACornerGivesOneSegmentFromThere) {
  for (std::uint32_t begin = 0; begin < 3; ++begin) {
    Scene scene;
    scene.positions_m = {{0, 0, 1}, {2, 0, 0}, {2, 4, 2}};
    scene.triangles = {{begin, (begin + 1) % 3, (begin + 2) % 3}};
    scene.class_of = {7};
    const std::vector<SliceSegment> segments = slice(scene, 1.0);
    ASSERT_EQ(segments.size(), 1u) << begin;
    EXPECT_EQ(segments[0].class_id, 7);
    const auto [a, b] = std::pair(segments[0].from_m, segments[0].to_m);
    EXPECT_LT(std::min(a.norm(), b.norm()), 1e-9);
    EXPECT_LT((a + b - Eigen::Vector2d(2, 2)).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace mh
