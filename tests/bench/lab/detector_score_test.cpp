// SPDX-License-Identifier: Apache-2.0
#include "bench/lab/detector_score.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace mh {
namespace {

constexpr ClassId kChair = 5, kTable = 7, kDesk = 14, kBed = 4;

/// An image of 200 x 100 px with a chair of 40 x 40 px, a table of 60 x 30 px and a desk of 40 x 50
/// px.
RenderedFrame room() {
  RenderedFrame frame;
  frame.classes = Grid2d<ClassId>(200, 100, 1);
  frame.instances = Grid2d<InstanceId>(200, 100, 1);
  const auto put = [&](int left, int top, int width, int height, ClassId id, InstanceId instance) {
    for (int y = top; y < top + height; ++y)
      for (int x = left; x < left + width; ++x) {
        frame.classes(x, y) = id;
        frame.instances(x, y) = instance;
      }
  };
  put(10, 10, 40, 40, kChair, 2);
  put(60, 10, 60, 30, kTable, 3);
  put(150, 10, 40, 50, kDesk, 4);
  return frame;
}

DetectedBox box(float left, float top, float width, float height, ClassId id, float score) {
  return {.left = left,
          .top = top,
          .right = left + width,
          .bottom = top + height,
          .score = score,
          .network_class = 0,
          .classes = {{{id, score}}}};
}

TEST(DetectorJudge, CountsWhatBecomesOfObjectsAndDetections) {
  DetectorJudge judge(0.5);
  // A correct box; a chair box on the table; a table box on the desk, which is not a COCO class; a
  // badly placed box; and one with too low a score.
  const auto missed =
      judge.add(room(), {box(10, 10, 40, 40, kChair, 0.9F), box(60, 10, 60, 30, kChair, 0.8F),
                         box(150, 10, 40, 50, kTable, 0.7F), box(30, 10, 40, 40, kChair, 0.6F),
                         box(60, 10, 60, 30, kTable, 0.4F)});
  EXPECT_TRUE(missed.empty());
  const DetectorScore score = judge.score();
  EXPECT_EQ(score.images, 1U);
  EXPECT_EQ(score.outcomes.at({kChair, kChair}), 1U);
  EXPECT_EQ(score.outcomes.at({kTable, kChair}), 1U);
  EXPECT_EQ(score.outcomes.at({kVoid, kTable}), 1U);
  EXPECT_EQ(score.false_alarms.at({kTable, kDesk}), 1U);
  EXPECT_EQ(score.badly_placed, 1U);
  EXPECT_DOUBLE_EQ(score.dials.recall_medium, 1);
  EXPECT_DOUBLE_EQ(score.dials.confusion, 0.5);
  EXPECT_DOUBLE_EQ(score.dials.false_alarms, 1);
  EXPECT_DOUBLE_EQ(score.dials.box_sigma, 0);
  ASSERT_EQ(score.classes.size(), 2U);  // the desk is not a COCO class
  EXPECT_DOUBLE_EQ(score.classes[0].precision.ap, 1);
  EXPECT_DOUBLE_EQ(score.classes[1].precision.ap, 0.5);  // ranked after the table box on the desk
}

TEST(DetectorJudge, MeasuresHowSidesStray) {
  DetectorJudge judge(0.5);
  const auto missed = judge.add(room(), {box(14, 10, 36, 40, kChair, 0.9F)});
  ASSERT_EQ(missed.size(), 1U);
  EXPECT_EQ(missed[0].class_id, kTable);
  const DetectorScore score = judge.score();
  EXPECT_NEAR(score.dials.box_sigma, 0.1 / 2, 1e-6);  // one of four sides is off by 4 of 40 px
  EXPECT_DOUBLE_EQ(score.dials.recall_medium, 0.5);
}

TEST(DetectorJudge, ComparesLabelsWithExactClasses) {
  RenderedFrame frame = room();
  Grid2d<float> depth_m(200, 100, 3.0F);
  for (int y = 10; y < 50; ++y)
    for (int x = 10; x < 50; ++x) depth_m(x, y) = 2.0F;  // the chair is in front of the wall
  DetectorJudge judge(0.5);
  judge.add(frame, {box(5, 5, 50, 50, kChair, 0.9F), box(60, 10, 60, 30, kChair, 0.8F)}, depth_m);
  const DetectorScore score = judge.score();
  EXPECT_NEAR(score.box.right_share, 1600.0 / (2500 + 1800), 1e-9);
  EXPECT_NEAR(score.foreground.right_share, 1600.0 / (1600 + 1800), 1e-9);
  EXPECT_NEAR(score.box.found_share, 1600.0 / 3400, 1e-9);
  EXPECT_NEAR(score.foreground.found_share, 1600.0 / 3400, 1e-9);
}

// A class without objects has no precision, and the mean is over those that have one.
TEST(DetectorJudge, TheMeanIsOverClassesWithObjects) {
  DetectorJudge judge(0.5);
  judge.add(room(), {box(10, 10, 40, 40, kChair, 0.9F), box(60, 10, 60, 30, kTable, 0.8F),
                     box(130, 60, 20, 20, kBed, 0.7F)});
  const DetectorScore score = judge.score();
  EXPECT_DOUBLE_EQ(score.mean.ap, 1);
  EXPECT_DOUBLE_EQ(score.mean.ap50, 1);
  EXPECT_TRUE(std::isnan(score.mean.small)) << "nothing is small";
}

}  // namespace
}  // namespace mh
