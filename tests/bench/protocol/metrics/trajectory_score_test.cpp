// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/metrics/trajectory_score.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace mh {
namespace {

Trajectory arc(int first, int last) {
  Trajectory path;
  for (int i = first; i < last; ++i)
    path.push_back({1000 * i, SE3(Eigen::Matrix3d::Identity(),
                                  Eigen::Vector3d(0.1 * i, 0.01 * i * i, 0.002 * i * i * i))});
  return path;
}

TEST(ScoreTrajectory, CompletenessIsOfAllFramesThatWereOffered) {
  const Trajectory truth = arc(0, 40);
  EXPECT_DOUBLE_EQ(score_trajectory(arc(0, 40), truth, 40).completeness, 1.0);
  EXPECT_DOUBLE_EQ(score_trajectory(arc(10, 20), truth, 40).completeness, 0.25);
  EXPECT_DOUBLE_EQ(score_trajectory({}, truth, 40).completeness, 0.0);
}

TEST(ScoreTrajectory, AMapOfAnotherScaleHasAnError) {
  Trajectory twice = arc(0, 40);
  for (TimedPose& pose : twice)
    pose.world_from_camera =
        SE3(pose.world_from_camera.rotation(), 2.0 * pose.world_from_camera.translation());
  const auto score = score_trajectory(twice, arc(0, 40), 40);
  ASSERT_TRUE(score.ate_rmse_m);
  EXPECT_GT(*score.ate_rmse_m, 0.5);
}

// Each camera is turned by 3 degrees about its own axis: the positions fit exactly, so alignment
// cannot remove the error.
TEST(ScoreTrajectory, OrientationsHaveAnErrorOfTheirOwn) {
  Trajectory turned = arc(0, 40);
  const double angle_rad = 3.0 * std::numbers::pi / 180.0;
  for (TimedPose& pose : turned)
    pose.world_from_camera =
        pose.world_from_camera *
        SE3(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d(1, 2, 2) / 3).toRotationMatrix(),
            Eigen::Vector3d::Zero());
  const TrajectoryScore score = score_trajectory(turned, arc(0, 40), 40);
  ASSERT_TRUE(score.ate_rmse_deg);
  EXPECT_NEAR(*score.ate_rmse_deg, 3.0, 1e-6);
  EXPECT_NEAR(score.ate_rmse_m.value(), 0.0, 1e-9);
}

// In a straight corridor the alignment is free to turn about the path, so any error of the angle
// would be arbitrary.
TEST(ScoreTrajectory, APathThatIsNearlyALineHasNoAngle) {
  const auto corridor = [](double width_m, double error_m) {
    Trajectory truth, estimate;
    for (int i = 0; i < 100; ++i) {
      const double side = std::sin(0.1 * i);
      truth.push_back({1000 * i, SE3(Eigen::Matrix3d::Identity(), {0.1 * i, width_m * side, 0})});
      estimate.push_back({1000 * i, SE3(Eigen::Matrix3d::Identity(),
                                        {0.1 * i, width_m * side, error_m * std::cos(0.3 * i)})});
    }
    return score_trajectory(estimate, truth, truth.size());
  };
  EXPECT_TRUE(corridor(1, 0.01).ate_rmse_deg);
  EXPECT_FALSE(corridor(0.02, 0.01).ate_rmse_deg);
  EXPECT_TRUE(corridor(0.02, 0.01).ate_rmse_m);
}

// One of forty poses is 8 m off: the root mean square shows it, the median does not.
TEST(ScoreTrajectory, TheMedianErrorForgivesAFewBadPoses) {
  Trajectory off = arc(0, 40);
  off[20].world_from_camera =
      SE3(off[20].world_from_camera.rotation(),
          off[20].world_from_camera.translation() + Eigen::Vector3d(0, 0, 8));
  const TrajectoryScore score = score_trajectory(off, arc(0, 40), 40);
  EXPECT_GT(score.ate_rmse_m.value(), 1.0);
  EXPECT_LT(score.ate_median_m.value(), 0.5);
  EXPECT_FALSE(score_trajectory({}, arc(0, 40), 40).ate_median_m);
}

}  // namespace
}  // namespace mh
