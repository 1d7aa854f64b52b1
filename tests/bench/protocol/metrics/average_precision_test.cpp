// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/metrics/average_precision.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <vector>

#include <nlohmann/json.hpp>

#include "source_dir.hpp"

namespace mh {
namespace {

TruthBox truth(std::size_t image, double left, double side) {
  return {{image, left, 0, side, side}, side * side};
}
ScoredBox found(std::size_t image, double left, double side, double score) {
  return {{image, left, 0, side, side}, score};
}

TEST(AveragePrecision, IsOneForPerfectBoxesAndUnknownWithoutTruth) {
  const std::vector<TruthBox> truths = {truth(0, 0, 50), truth(1, 20, 50)};
  const std::vector<ScoredBox> boxes = {found(0, 0, 50, 0.9), found(1, 20, 50, 0.3)};
  const AveragePrecision perfect = average_precision(truths, boxes);
  EXPECT_DOUBLE_EQ(perfect.ap, 1);
  EXPECT_DOUBLE_EQ(perfect.medium, 1);
  EXPECT_TRUE(std::isnan(perfect.small));
  EXPECT_EQ(perfect.truths, 2U);
  EXPECT_TRUE(std::isnan(average_precision({}, boxes).ap));
  EXPECT_EQ(average_precision(truths, {}).ap, 0);
}

// Three true boxes; in order of score, the detected boxes are right, wrong, right. Precision is 1
// up to a recall of 1/3 (34 of the 101 recalls: 0 to 0.33), 2/3 up to a recall of 2/3 (33 of them:
// 0.34 to 0.66), then 0.
TEST(AveragePrecision, InterpolatesAt101Recalls) {
  const std::vector<TruthBox> truths = {truth(0, 0, 50), truth(0, 100, 50), truth(1, 0, 50)};
  const std::vector<ScoredBox> boxes = {found(1, 0, 50, 0.9), found(1, 300, 50, 0.8),
                                        found(0, 100, 50, 0.7)};
  EXPECT_NEAR(average_precision(truths, boxes).ap, (34 * 1.0 + 33 * (2.0 / 3)) / 101, 1e-12);
}

// A box of 50 px displaced by d has an overlap of (50 - d) / (50 + d): 11 px give 0.639, which
// counts only at 0.50, 0.55 and 0.60.
TEST(AveragePrecision, IsTheMeanOverTenOverlaps) {
  const AveragePrecision displaced =
      average_precision(std::vector{truth(0, 0, 50)}, std::vector{found(0, 11, 50, 0.9)});
  EXPECT_NEAR(displaced.ap, 0.3, 1e-12);
  EXPECT_DOUBLE_EQ(displaced.ap50, 1);
  EXPECT_DOUBLE_EQ(displaced.ap75, 0);
}

TEST(AveragePrecision, TakesEachTruthOnce) {
  const std::vector<ScoredBox> twice = {found(0, 0, 50, 0.9), found(0, 1, 50, 0.95)};
  // The second of two boxes is wrong, but comes after the only right one: precision 1 at every
  // recall.
  EXPECT_DOUBLE_EQ(average_precision(std::vector{truth(0, 0, 50)}, twice).ap50, 1);
  // With a second true box, precision is 1 at half of the recalls (0 to 0.50): 51 of 101.
  EXPECT_NEAR(average_precision(std::vector{truth(0, 0, 50), truth(0, 500, 50)}, twice).ap50,
              51.0 / 101, 1e-12);
}

TEST(AveragePrecision, OfASizeIgnoresTheOthers) {
  const std::vector<TruthBox> truths = {truth(0, 0, 20), truth(0, 100, 50), truth(0, 300, 100)};
  const std::vector<ScoredBox> boxes = {found(0, 100, 50, 0.9), found(0, 0, 20, 0.8)};
  const AveragePrecision ap = average_precision(truths, boxes);
  EXPECT_DOUBLE_EQ(ap.small, 1);  // the medium box is matched with a true box that does not count
  EXPECT_DOUBLE_EQ(ap.medium, 1);
  EXPECT_DOUBLE_EQ(ap.large, 0);
}

TEST(AveragePrecision, IgnoredTruthsCountNeitherWay) {
  std::vector<TruthBox> truths = {truth(0, 0, 50), truth(0, 100, 8)};
  truths[1].ignore = true;
  EXPECT_DOUBLE_EQ(average_precision(truths, std::vector{found(0, 0, 50, 0.5)}).ap, 1);
  EXPECT_DOUBLE_EQ(
      average_precision(truths, std::vector{found(0, 100, 8, 0.9), found(0, 0, 50, 0.5)}).ap, 1);
  EXPECT_LT(average_precision(truths, std::vector{found(0, 200, 8, 0.9), found(0, 0, 50, 0.5)}).ap,
            0.51);
}

TEST(AveragePrecision, KeepsAHundredBoxesOfAnImage) {
  std::vector<ScoredBox> boxes;
  for (int i = 0; i < 100; ++i) boxes.push_back(found(0, 1000 + 100 * i, 50, 0.9));
  boxes.push_back(found(0, 0, 50, 0.5));
  EXPECT_EQ(average_precision(std::vector{truth(0, 0, 50)}, boxes).ap, 0);
  boxes.erase(boxes.begin());
  EXPECT_GT(average_precision(std::vector{truth(0, 0, 50)}, boxes).ap, 0);
}

// 30 images with three classes of boxes at whole pixels, and the results of pycocotools (cocoapi
// 8c9bcc3) for each class: AP, AP50, AP75, small, medium, large.
TEST(AveragePrecision, IsThatOfPycocotools) {
  constexpr std::array<std::array<double, 6>, 3> kTheirs = {
      {{0.23081135298727457, 0.4578608594660631, 0.20078831541679365, 0.08810044914265863,
        0.2642015450264813, 0.4496003407454685},
       {0.22523831993537322, 0.38737857615825694, 0.19856252255555626, 0.039606532081779604,
        0.25882467194087827, 0.5252446929788069},
       {0.2641695977570601, 0.538266803226657, 0.23128128624201275, 0.18815676897360067,
        0.26162221789011636, 0.48807017543859654}}};
  std::ifstream file(MH_SOURCE_DIR "/tests/bench/protocol/metrics/coco_case.json");
  const auto json = nlohmann::json::parse(file);
  for (std::size_t k = 0; k < kTheirs.size(); ++k) {
    const auto box = [](const nlohmann::json& row) {
      return ImageBox{row[0], row[2], row[3], row[4], row[5]};
    };
    std::vector<TruthBox> truths;
    std::vector<ScoredBox> boxes;
    for (const auto& row : json["truths"])
      if (row[1] == k) truths.push_back({box(row), row[6]});
    for (const auto& row : json["found"])
      if (row[1] == k) boxes.push_back({box(row), row[6]});
    const AveragePrecision ap = average_precision(truths, boxes);
    const std::array<double, 6> ours = {ap.ap, ap.ap50, ap.ap75, ap.small, ap.medium, ap.large};
    for (std::size_t i = 0; i < ours.size(); ++i)
      EXPECT_NEAR(ours[i], kTheirs[k][i], 1e-12) << k << " " << i;
  }
}

}  // namespace
}  // namespace mh
