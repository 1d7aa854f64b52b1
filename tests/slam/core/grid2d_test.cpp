// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include <gtest/gtest.h>

#include "slam/core/grid2d.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {
namespace {

template <class T>
bool starts_a_line(const Grid2d<T>& grid) {
  return reinterpret_cast<std::uintptr_t>(grid.data()) % 64 == 0;
}

TEST(Grid2d, StartsAtALineOfTheCacheAndKeepsWhatItIsGiven) {
  for (int width = 1; width < 200; width += 7) {
    const Grid2d<Rgb8> colors(width, 3, Rgb8{1, 2, 3});
    const Grid2d<float> zeros(width, 5);
    EXPECT_TRUE(starts_a_line(colors) && starts_a_line(zeros)) << width;
    for (const Rgb8& color : colors) ASSERT_EQ(color, (Rgb8{1, 2, 3}));
    for (const float zero : zeros) ASSERT_EQ(zero, 0.0F);
    Grid2d<Rgb8> copy = colors;
    EXPECT_TRUE(starts_a_line(copy));
    EXPECT_EQ(copy, colors);
    copy(width - 1, 2) = {};
    EXPECT_NE(copy, colors);
    EXPECT_EQ(colors(width - 1, 2), (Rgb8{1, 2, 3}));
  }
}

TEST(Grid2d, AnUnfilledOneHasItsSize) {
  Grid2d<std::uint16_t> grid(31, 7, Unfilled{});
  EXPECT_TRUE(starts_a_line(grid));
  EXPECT_EQ(grid.size(), 31U * 7U);
  for (std::uint16_t& value : grid) value = 5;
  EXPECT_EQ(grid, Grid2d<std::uint16_t>(31, 7, 5));
}

}  // namespace
}  // namespace mh
