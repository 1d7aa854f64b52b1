// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/detected.hpp"

#include <gtest/gtest.h>

#include "slam/detect/detected_sequence.hpp"
#include "slam/io/error.hpp"
#include "tests/slam/core/made_sequence.hpp"

namespace mh {
namespace {

constexpr ClassId kChair = 5, kTable = 7;

DetectedBox box(float left, float top, float right, float bottom, ClassId id, float score) {
  return {.left = left,
          .top = top,
          .right = right,
          .bottom = bottom,
          .score = score,
          .network_class = 0,
          .classes = {{{id, score}}}};
}

TEST(LabelsOf, BetterBoxesCoverWorseOnesAndTheRestIsBackground) {
  Detected found;
  found.boxes = {box(4, 4, 12, 12, kChair, 0.9F), box(0, 0, 8, 8, kTable, 0.5F)};
  const SemanticImage image = labels_of(found, {}, 16, 16, BoxFill::kBox);
  EXPECT_EQ(image.at(0, 0).most_probable(), kTable);
  EXPECT_EQ(image.at(7, 7).most_probable(), kChair);
  EXPECT_EQ(image.at(11, 11).most_probable(), kChair);
  EXPECT_EQ(image.at(12, 12).most_probable(), kBackground);
  EXPECT_FLOAT_EQ(image.at(4, 4).entries[0].second, 0.9F);
}

TEST(LabelsOf, ABoxOfNoClassOfOursIsVoid) {
  Detected found;
  found.boxes = {box(2, 2, 6, 6, kChair, 0.9F)};
  found.boxes[0].classes = {};
  const SemanticImage image = labels_of(found, {}, 8, 8, BoxFill::kBox);
  EXPECT_TRUE(image.at(3, 3).entries.empty());
  EXPECT_EQ(image.at(0, 0).most_probable(), kBackground);
}

/// A surface at 2 m in the middle of the box, with a wall at 3 m behind it.
Grid2d<float> surface_before_wall() {
  Grid2d<float> depth_m(40, 40, 3.0F);
  for (int y = 10; y < 30; ++y)
    for (int x = 12; x < 28; ++x) depth_m(x, y) = 2.0F + 0.002F * static_cast<float>(x);
  return depth_m;
}

TEST(ForegroundDepth, IsThatOfTheSurfaceInFront) {
  const Grid2d<float> depth_m = surface_before_wall();
  const DepthRange range = foreground_depth(box(8, 8, 32, 32, kChair, 1), depth_m);
  EXPECT_TRUE(range.contains(2.05F));
  EXPECT_FALSE(range.contains(3.0F));
}

TEST(ForegroundDepth, IsTheWholeBoxWhereItHasOneSurface) {
  Grid2d<float> depth_m(40, 40, 0.0F);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) depth_m(x, y) = 2.0F + 0.004F * static_cast<float>(x);
  const DepthRange range = foreground_depth(box(0, 0, 40, 40, kChair, 1), depth_m);
  EXPECT_TRUE(range.contains(2.0F));
  EXPECT_TRUE(range.contains(2.16F));
}

// A table seen along its length: half of it is closer than two thirds of the depth of the other
// half, yet there is no edge in between.
TEST(ForegroundDepth, KeepsALongThingWhole) {
  Grid2d<float> depth_m(40, 40, 0.0F);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) depth_m(x, y) = 3.0F - 0.04F * static_cast<float>(y);
  const DepthRange range = foreground_depth(box(0, 0, 40, 40, kChair, 1), depth_m);
  EXPECT_TRUE(range.contains(3.0F));
  EXPECT_TRUE(range.contains(1.44F));
}

TEST(ForegroundDepth, LeavesOutAThingInFrontThatMissesTheMiddle) {
  Grid2d<float> depth_m(40, 40, 3.0F);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 8; ++x) depth_m(x, y) = 1.0F;  // a door frame
  const DepthRange range = foreground_depth(box(0, 0, 40, 40, kChair, 1), depth_m);
  EXPECT_FALSE(range.contains(1.0F));
  EXPECT_TRUE(range.contains(3.0F));
}

TEST(LabelsOf, ForegroundKeepsPixelsWithoutDepth) {
  Grid2d<float> depth_m = surface_before_wall();
  depth_m(9, 9) = 0;
  Detected found;
  found.boxes = {box(8, 8, 32, 32, kChair, 0.9F)};
  const SemanticImage image = labels_of(found, depth_m, 40, 40, BoxFill::kForeground);
  EXPECT_EQ(image.at(20, 20).most_probable(), kChair);
  EXPECT_EQ(image.at(10, 10).most_probable(), kBackground);
  EXPECT_EQ(image.at(9, 9).most_probable(), kChair);
}

TEST(DecodeDetected, ReversesEncode) {
  Detected found;
  found.boxes = {box(1, 2, 3.5F, 4, kChair, 0.9F), box(0, 0, 8, 8, kTable, 0.5F)};
  found.clipped = 3;
  EXPECT_EQ(decode_detected(encode(found)), found);
  found.pixels = {Grid2d<std::uint8_t>(5, 4, 1), {{}, ClassDistribution::one_hot(kChair)}};
  const std::string bytes = encode(found);
  EXPECT_EQ(decode_detected(bytes), found);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(decode_detected(bytes.substr(0, size)), InputError) << size;
}

}  // namespace
}  // namespace mh
