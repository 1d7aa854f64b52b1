// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/label_faults.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "sim/sensors/labels.hpp"

namespace mh {
namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr ClassId kWall = 1, kBed = 4, kFaultyChair = 5, kTable = 7;

RenderedFrame unpainted_frame() {
  return {Grid2d<Rgb8>(kWidth, kHeight), Grid2d<float>(kWidth, kHeight, 2.0F),
          Grid2d<ClassId>(kWidth, kHeight), Grid2d<InstanceId>(kWidth, kHeight)};
}

void paint(RenderedFrame& frame, int left, int top, int width, int height, ClassId class_id,
           InstanceId instance) {
  for (int y = top; y < top + height; ++y)
    for (int x = left; x < left + width; ++x) {
      frame.classes(x, y) = class_id;
      frame.instances(x, y) = instance;
    }
}

/// 12 x 9 chairs of 20 x 20 px, instances 1 to 108.
RenderedFrame row_of_chairs() {
  RenderedFrame frame = unpainted_frame();
  for (int i = 0; i < 108; ++i)
    paint(frame, i % 12 * 26 + 2, i / 12 * 26 + 2, 20, 20, kFaultyChair,
          static_cast<InstanceId>(i + 1));
  return frame;
}

SE3 view_at(double x_m, double heading_rad = 0.0) {
  return {Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitY()).toRotationMatrix(),
          {x_m, 0.3, 0.7}};
}

SemanticImage labels(const RenderedFrame& truth, LabelMode mode, const LabelConfig& config,
                     const SE3& view = view_at(0), std::uint64_t frame = 0) {
  return label_image(truth, mode, config, view, RandomStream(frame));
}

/// Number of chairs in row_of_chairs() whose center has this class.
int count(const SemanticImage& image, ClassId class_id) {
  int found = 0;
  for (int i = 0; i < 108; ++i)
    found += image.at(i % 12 * 26 + 12, i / 12 * 26 + 12).most_probable() == class_id;
  return found;
}

TEST(WrongClass, IsAnyOtherOfItsKindAndNeverTheTruth) {
  for (const ClassInfo& truth : classes()) {
    std::set<ClassId> expected, drawn;
    for (const ClassInfo& other : classes())
      if (other.id != truth.id && other.id != kVoid && other.id != kBackground &&
          (other.coco80 >= 0) == (truth.coco80 >= 0))
        expected.insert(other.id);
    for (std::uint64_t bits = 0; bits < 200; ++bits) drawn.insert(wrong_class(truth.id, bits));
    EXPECT_EQ(drawn, expected) << truth.name;
    EXPECT_TRUE(expected.contains(wrong_class(truth.id, UINT64_MAX)));
  }
}

TEST(LabelNoise, NoneIsNone) {
  const RenderedFrame truth = row_of_chairs();
  for (const LabelMode mode : {LabelMode::kNone, LabelMode::kExact, LabelMode::kBoxes})
    EXPECT_EQ(labels(truth, mode, {}), label_image(truth, mode));
}

TEST(LabelNoise, DialsAreSharesOfInstances) {
  const RenderedFrame truth = row_of_chairs();
  for (const double share : {0.1, 0.5}) {
    int confused = 0, dropped = 0, trials = 0;
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
      LabelConfig config{.seed = seed};
      config.noise = {.enabled = true, .confusion = share};
      confused += 108 - count(labels(truth, LabelMode::kExact, config), kFaultyChair);
      config.noise = {.enabled = true, .dropout = share};
      dropped += count(labels(truth, LabelMode::kExact, config), kVoid);
      EXPECT_EQ(count(labels(truth, LabelMode::kBoxes, config), kBackground),
                count(labels(truth, LabelMode::kExact, config), kVoid));
      trials += 108;
    }
    // Instances are drawn independently: a binomial spread with 3,240 trials.
    const double spread = 4.0 * std::sqrt(share * (1.0 - share) / trials);
    EXPECT_NEAR(static_cast<double>(confused) / trials, share, spread);
    EXPECT_NEAR(static_cast<double>(dropped) / trials, share, spread);
  }
}

TEST(LabelNoise, AnInstanceIsConfusedAsAWholeAndAlwaysWithTheSameClass) {
  const RenderedFrame truth = row_of_chairs();
  LabelConfig config{.persistent_share = 0.0, .frame_share = 1.0};
  config.noise = {.enabled = true, .confusion = 1.0};
  const SemanticImage a = labels(truth, LabelMode::kExact, config, view_at(0), 1);
  EXPECT_EQ(count(a, kFaultyChair), 0);
  EXPECT_EQ(a, labels(truth, LabelMode::kExact, config, view_at(7), 2));
  for (int y = 2; y < 22; ++y)
    for (int x = 2; x < 22; ++x) ASSERT_EQ(a.at(x, y), a.at(12, 12));
  EXPECT_GE(classes()[a.at(12, 12).most_probable()].coco80,
            0);  // the class is still one that has boxes
}

TEST(LabelNoise, FaultsStayWithTheViewAndFadeWithDistance) {
  const RenderedFrame truth = row_of_chairs();
  LabelConfig config{.persistent_share = 0.0, .frame_share = 0.0};
  config.noise = {.enabled = true, .dropout = 0.5};
  const SemanticImage here = labels(truth, LabelMode::kExact, config, view_at(0.2), 1);
  EXPECT_EQ(here, labels(truth, LabelMode::kExact, config, view_at(0.2), 2));
  const auto differing = [&](const SE3& view) {
    const SemanticImage there = labels(truth, LabelMode::kExact, config, view);
    int differ = 0;
    for (int i = 0; i < 108; ++i) {
      const int x = i % 12 * 26 + 12, y = i / 12 * 26 + 12;
      differ += here.at(x, y) != there.at(x, y);
    }
    return differ;
  };
  EXPECT_LT(differing(view_at(0.22)), 8);
  EXPECT_LT(differing(view_at(0.22)), differing(view_at(0.5)));
  EXPECT_NEAR(differing(view_at(5.0)), 54, 22);  // effectively independent: half of them
  EXPECT_NEAR(differing(view_at(0.2, 1.5)), 54, 22);
}

TEST(LabelNoise, SharesOfTheVarianceAreThoseStated) {
  LabelConfig config{.persistent_share = 0.4, .frame_share = 0.1};
  const FaultDraws first(config, view_at(0.3), RandomStream(1));
  const FaultDraws again(config, view_at(0.3), RandomStream(2));
  const FaultDraws elsewhere(config, view_at(40.7, 2.0), RandomStream(3));
  double square = 0, same_view = 0, same_thing = 0;
  constexpr int kThings = 20000;
  for (std::uint64_t thing = 0; thing < kThings; ++thing) {
    const double a = first.normal(9, thing);
    square += a * a / kThings;
    same_view += a * again.normal(9, thing) / kThings;
    same_thing += a * elsewhere.normal(9, thing) / kThings;
  }
  EXPECT_NEAR(square, 1.0, 0.04);
  EXPECT_NEAR(same_view, 0.9, 0.04);
  EXPECT_NEAR(same_thing, 0.4, 0.04);
}

TEST(LabelNoise, SwappedNeighborsExchangeTheirClasses) {
  RenderedFrame truth = unpainted_frame();
  paint(truth, 10, 10, 50, 50, kFaultyChair, 1);
  paint(truth, 70, 10, 50, 50, kTable, 2);  // nearest to both of the others
  paint(truth, 200, 10, 50, 50, kBed, 3);
  LabelConfig config;
  config.noise = {.enabled = true, .swap = 1.0};
  const SemanticImage image = labels(truth, LabelMode::kExact, config);
  EXPECT_EQ(image.at(30, 30).most_probable(), kTable);
  EXPECT_EQ(image.at(90, 30).most_probable(), kFaultyChair);
  EXPECT_EQ(image.at(220, 30).most_probable(), kBed);  // no neighbor is left to exchange with
}

TEST(LabelNoise, ErosionMakesVoidWhatIsNearABorder) {
  RenderedFrame truth = unpainted_frame();
  paint(truth, 0, 0, kWidth, kHeight, kWall, 1);
  paint(truth, 100, 80, 60, 40, kTable, 2);
  for (const int radius : {1, 3, 8}) {
    LabelConfig config;
    config.noise = {.enabled = true, .erosion_px = radius};
    const SemanticImage image = labels(truth, LabelMode::kExact, config);
    const auto inside = [](int x, int y, int margin) {
      return x >= 100 - margin && x < 160 + margin && y >= 80 - margin && y < 120 + margin;
    };
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const ClassId expected = inside(x, y, -radius)  ? kTable
                                 : inside(x, y, radius) ? kVoid
                                                        : kWall;
        ASSERT_EQ(image.at(x, y).most_probable(), expected) << radius << ": " << x << " " << y;
      }
  }
}

}  // namespace
}  // namespace mh
