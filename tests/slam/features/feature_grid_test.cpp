// SPDX-License-Identifier: Apache-2.0
#include "slam/features/feature_grid.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "slam/core/random.hpp"

namespace mh {
namespace {

// The result must equal that of a scan of all keypoints: those in the 16 px cells that the square
// touches, cell by cell from the upper left and in order within a cell; none twice, and no others.
TEST(FeatureGrid, VisitsExactlyWhatLiesInTheCellsThatASquareTouches) {
  Camera camera;
  camera.width_px = 100, camera.height_px = 70;  // not a whole number of cells
  const auto column = [](float u) {
    return std::clamp(static_cast<int>(std::floor(u / 16)), 0, 6);
  };
  const auto row = [](float v) { return std::clamp(static_cast<int>(std::floor(v / 16)), 0, 4); };
  const RandomStream draw(5);
  std::vector<Keypoint> keypoints;
  for (std::uint64_t i = 0; i < 400; ++i) {
    // Undistorted keypoints may be outside the image; some are on the borders of cells.
    Keypoint k;
    k.u_px = static_cast<float>(draw.uniform(2 * i, -20, 120));
    k.v_px = static_cast<float>(draw.uniform(2 * i + 1, -20, 90));
    if (i % 4 == 0) k.u_px = std::round(k.u_px / 16) * 16;
    keypoints.push_back(k);
  }
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, keypoints.size()}) {
    const std::vector<Keypoint> some(keypoints.begin(),
                                     keypoints.begin() + static_cast<std::ptrdiff_t>(count));
    const FeatureGrid grid(some, camera);
    for (std::uint64_t q = 0; q < 300; ++q) {
      const auto u = static_cast<float>(draw.fork(1).uniform(2 * q, -30, 130));
      const auto v = static_cast<float>(draw.fork(1).uniform(2 * q + 1, -30, 100));
      const auto radius = static_cast<float>(q % 40);
      std::vector<std::uint32_t> expected, visited;
      for (int y = row(v - radius); y <= row(v + radius); ++y)
        for (int x = column(u - radius); x <= column(u + radius); ++x)
          for (std::uint32_t i = 0; i < some.size(); ++i)
            if (column(some[i].u_px) == x && row(some[i].v_px) == y) expected.push_back(i);
      grid.for_each_near(u, v, radius,
                         [&](const FeatureGrid::Entry& k) { visited.push_back(k.index); });
      ASSERT_EQ(visited, expected) << u << " " << v << " " << radius;
      for (std::uint32_t i = 0; i < some.size(); ++i)
        if (std::abs(some[i].u_px - u) <= radius && std::abs(some[i].v_px - v) <= radius) {
          ASSERT_TRUE(std::ranges::count(visited, i)) << "it is within the square";
        }
    }
  }
}

}  // namespace
}  // namespace mh
