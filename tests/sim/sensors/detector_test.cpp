// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/sensors/labels.hpp"

namespace mh {
namespace {

constexpr ClassId kCabinet = 3, kChair = 5;

RenderedFrame empty_frame() {
  const Camera camera;
  const int w = camera.width_px, h = camera.height_px;
  return {Grid2d<Rgb8>(w, h), Grid2d<float>(w, h, 2.0F), Grid2d<ClassId>(w, h),
          Grid2d<InstanceId>(w, h)};
}

void paint(RenderedFrame& frame, int left, int top, int size, ClassId class_id,
           InstanceId instance) {
  for (int y = top; y < top + size; ++y)
    for (int x = left; x < left + size; ++x) {
      frame.classes(x, y) = class_id;
      frame.instances(x, y) = instance;
    }
}

/// Chairs of 20, 60 or 100 px (small, medium, large) that do not touch each other.
RenderedFrame chairs(int size) {
  RenderedFrame frame = empty_frame();
  InstanceId instance = 0;
  for (int y = 15; y + size + 15 < 480; y += size + 30)
    for (int x = 15; x + size + 15 < 640; x += size + 30)
      paint(frame, x, y, size, kChair, ++instance);
  return frame;
}

int count(const RenderedFrame& frame) {
  return *std::max_element(frame.instances.begin(), frame.instances.end());
}

DetectorConfig perfect() {
  return {.recall_small = 1,
          .recall_medium = 1,
          .recall_large = 1,
          .confusion = 0,
          .false_alarms = 0,
          .box_sigma = 0};
}

std::vector<Detection> detections(const RenderedFrame& truth, const DetectorConfig& detector,
                                  std::uint64_t seed) {
  LabelConfig config{.detector = detector, .seed = seed};
  return detect(truth, config, SE3(), RandomStream(seed));
}

TEST(Detector, APerfectOneDrawsTheExactBoxes) {
  RenderedFrame truth = chairs(60);
  paint(truth, 20, 20, 30, kCabinet,
        200);  // not a class of the detector, and in the way of one chair
  LabelConfig config{.detector = perfect()};
  const SemanticImage drawn =
      label_image(truth, LabelMode::kDetector, config, SE3(), RandomStream(1));
  const SemanticImage exact = label_image(truth, LabelMode::kBoxes);
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) {
      ASSERT_EQ(drawn.at(x, y).most_probable(), exact.at(x, y).most_probable());
      float sum = 0.0F;
      for (const auto& [id, p] : drawn.at(x, y).entries) sum += p;
      ASSERT_NEAR(sum, 1.0F, 1e-6F);
    }
  EXPECT_EQ(label_image(truth, LabelMode::kDetector), exact);
}

TEST(Detector, RecallBySizeIsThatOfTheTable) {
  const DetectorConfig published;
  // Redmon and Farhadi, table 3: AP_S, AP_M, AP_L times AP50 / AP.
  EXPECT_NEAR(published.recall_small, 0.183 * 0.579 / 0.330, 0.001);
  EXPECT_NEAR(published.recall_medium, 0.354 * 0.579 / 0.330, 0.001);
  EXPECT_NEAR(published.recall_large, 0.419 * 0.579 / 0.330, 0.001);
  DetectorConfig config = published;
  config.false_alarms = 0.0;
  for (const auto& [size, recall] :
       {std::pair(20, 0.321), std::pair(60, 0.621), std::pair(100, 0.735)}) {
    const RenderedFrame truth = chairs(size);
    double found = 0, all = 0;
    for (std::uint64_t seed = 0; all < 5000; ++seed) {
      found += static_cast<double>(detections(truth, config, seed).size());
      all += count(truth);
    }
    EXPECT_NEAR(found / all, recall, 4.0 * std::sqrt(recall * (1 - recall) / all)) << size;
  }
}

TEST(Detector, TooSmallAnObjectIsNeverFound) {
  RenderedFrame truth = empty_frame();
  paint(truth, 100, 100, 9, kChair, 1);  // 81 px
  EXPECT_TRUE(detections(truth, perfect(), 1).empty());
}

double overlap(const Detection& box, int left, int top, int size) {
  const auto span = [](int a0, int a1, int b0, int b1) {
    return std::max(0, std::min(a1, b1) - std::max(a0, b0) + 1);
  };
  const double both = span(box.left, box.right, left, left + size - 1) *
                      span(box.top, box.bottom, top, top + size - 1);
  const double own = (box.right - box.left + 1.0) * (box.bottom - box.top + 1.0);
  return both / (own + static_cast<double>(size) * size - both);
}

TEST(Detector, BoxesStrayAsFarAsTheTableSays) {
  // AP75 / AP50 and AP / AP50: the share of the boxes with an IoU above 0.5 whose IoU is above
  // 0.75, and the mean of such shares over the ten thresholds 0.5 to 0.95.
  DetectorConfig config = perfect();
  config.box_sigma = DetectorConfig{}.box_sigma;
  RenderedFrame truth = empty_frame();
  paint(truth, 200, 150, 150, kChair, 1);
  double above_half = 0, above_three_quarters = 0, over_thresholds = 0;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    const double iou = overlap(detections(truth, config, seed).at(0), 200, 150, 150);
    above_half += iou > 0.5;
    above_three_quarters += iou > 0.75;
    for (int k = 0; k < 10; ++k) over_thresholds += 0.1 * (iou > 0.5 + 0.05 * k);
  }
  EXPECT_NEAR(above_three_quarters / above_half, 34.4 / 57.9, 0.04);
  EXPECT_NEAR(over_thresholds / above_half, 33.0 / 57.9, 0.04);
}

TEST(Detector, ConfusionAndFalseAlarmsComeAtTheirRates) {
  const DetectorConfig published;
  DetectorConfig config = perfect();
  config.confusion = published.confusion;
  config.false_alarms = published.false_alarms;
  RenderedFrame truth = chairs(60);
  const int chairs_in_view = count(truth);
  // The only object in view that may get a false alarm.
  paint(truth, 590, 430, 40, kCabinet, 500);
  double confused = 0, all = 0, alarms = 0, images = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    for (const Detection& box : detections(truth, config, seed)) {
      if (box.instance == 500) {
        alarms += 1;
        continue;
      }
      all += 1;
      confused += box.classes.most_probable() != kChair;
      EXPECT_GE(classes()[box.classes.most_probable()].coco80, 0);
    }
    images += 1;
  }
  EXPECT_EQ(all, 400.0 * chairs_in_view);
  EXPECT_NEAR(confused / all, published.confusion, 4 * std::sqrt(0.1 * 0.9 / all));
  EXPECT_NEAR(alarms / images, published.false_alarms,
              4 * std::sqrt(published.false_alarms / images));
}

TEST(Detector, TheSameViewGivesTheSameAnswerButForWhatIsDrawnAfresh) {
  const RenderedFrame truth = chairs(20);
  LabelConfig config{.frame_share = 0.0};
  const auto found = [&](std::uint64_t frame) {
    return label_image(truth, LabelMode::kDetector, config, SE3(), RandomStream(frame));
  };
  EXPECT_EQ(found(1), found(2));
  config.frame_share = 0.1;
  EXPECT_NE(found(1), found(2));
}

}  // namespace
}  // namespace mh
