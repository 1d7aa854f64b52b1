// SPDX-License-Identifier: Apache-2.0
#include "bench/results/spread.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace mh {
namespace {

/// A quarter of a circle of 2 m in a second.
Trajectory quarter(double scale = 1) {
  Trajectory path;
  for (int i = 0; i < 30; ++i) {
    const double a = 0.05 * i;
    path.push_back({1'000'000'000 + i * 33'333'333LL,
                    SE3(Eigen::AngleAxisd(a, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
                        {2 * scale * std::cos(a), 2 * scale * std::sin(a), 0})});
  }
  return path;
}

TEST(Spread, OfAPathThatIsOnlyElsewhereIsNone) {
  Trajectory elsewhere = quarter();
  const SE3 there(Eigen::AngleAxisd(1, Eigen::Vector3d::UnitX()).toRotationMatrix(), {5, 6, 7});
  for (TimedPose& pose : elsewhere) pose.world_from_camera = there * pose.world_from_camera;
  const Spread::Change change = moved("other draws", quarter(), elsewhere, 30);
  ASSERT_TRUE(change.rmse_m);
  EXPECT_NEAR(*change.rmse_m, 0, 1e-9);
  EXPECT_EQ(change.both, 1);
}

TEST(Spread, OfAPathOfAnotherSizeIsWhatIsLeftAfterAlignment) {
  const Spread::Change change = moved("noise", quarter(), quarter(1.1), 60);
  ASSERT_TRUE(change.rmse_m);
  EXPECT_GT(*change.rmse_m, 0.01);
  EXPECT_LT(*change.rmse_m, 0.2);
  EXPECT_EQ(change.both, 0.5);
}

TEST(Spread, APathBackwardGetsItsStampsBack) {
  const Trajectory path = quarter();
  const Stamp first_ns = path.front().stamp_ns, last_ns = path.back().stamp_ns;
  Trajectory backward;
  for (auto pose = path.rbegin(); pose != path.rend(); ++pose)
    backward.push_back({first_ns + last_ns - pose->stamp_ns, pose->world_from_camera});
  const Trajectory again = turned_back(backward, first_ns, last_ns);
  ASSERT_EQ(again.size(), path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    EXPECT_EQ(again[i].stamp_ns, path[i].stamp_ns);
    EXPECT_EQ(again[i].world_from_camera.numbers(), path[i].world_from_camera.numbers());
  }
}

TEST(Spread, RanksSystemsAsTheTruthDoesOrNot) {
  std::vector<Spread> all(4);
  for (std::size_t i = 0; i < 4; ++i) {
    all[i].median_m = 0.01 * static_cast<double>(i + 1);
    all[i].ate_rmse_m = 0.1 * static_cast<double>(i + 1);
  }
  EXPECT_DOUBLE_EQ(*rank_of_truth(all), 1);
  for (std::size_t i = 0; i < 4; ++i) all[i].ate_rmse_m = 1.0 / static_cast<double>(i + 1);
  EXPECT_DOUBLE_EQ(*rank_of_truth(all), -1);
  all[0].ate_rmse_m.reset();
  EXPECT_FALSE(rank_of_truth(all)) << "three are too few";
}

}  // namespace
}  // namespace mh
