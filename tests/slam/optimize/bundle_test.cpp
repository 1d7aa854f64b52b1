// SPDX-License-Identifier: Apache-2.0
#include "slam/optimize/bundle.hpp"

#include <array>
#include <utility>

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>

#include "slam/optimize/reprojection.hpp"
#include "tests/slam/optimize/bundle_problem.hpp"
#include "tests/slam/optimize/synthetic.hpp"

namespace mh {
namespace {

using testing::BundleShape;
using testing::make_bundle;
using testing::SyntheticBundle;

const Camera kBundleCamera{};

double chi2_of(const BundleObservation& o, const std::vector<SE3>& poses,
               const std::vector<Eigen::Vector3d>& points) {
  const Eigen::Vector3d p = poses[o.pose] * points[o.point];
  if (p.z() <= 0) return 1e9;
  double d = o.disparity_px < 0 ? 0 : kBundleCamera.disparity_px(p.z()) - o.disparity_px;
  d /= testing::disparity_sigma_px(kBundleCamera);
  const Eigen::Vector2d e = kBundleCamera.project(p) - Eigen::Vector2d(o.u_px, o.v_px);
  return (e.squaredNorm() + d * d) / (static_cast<double>(o.sigma_px) * o.sigma_px);
}

double huber_cost(const BundleProblem& problem, const std::vector<SE3>& poses,
                  const std::vector<Eigen::Vector3d>& points) {
  const BundleConfig gates;
  double sum = 0;
  for (const BundleObservation& o : problem.observations)
    sum += huber_loss(chi2_of(o, poses, points),
                      o.disparity_px < 0 ? gates.chi2_mono : gates.chi2_stereo);
  return sum;
}

/// Independent of our code: rotation vectors instead of matrices, automatic derivatives.
struct CeresCost {
  BundleObservation o;

  template <class T>
  bool operator()(const T* pose, const T* point, T* residual) const {
    T p[3];
    ceres::AngleAxisRotatePoint(pose, point, p);
    for (int k = 0; k < 3; ++k) p[k] += pose[3 + k];
    const double sigma = static_cast<double>(o.sigma_px);
    residual[0] = (kBundleCamera.fx_px * p[0] / p[2] + kBundleCamera.cx_px - T(o.u_px)) / sigma;
    residual[1] = (kBundleCamera.fy_px * p[1] / p[2] + kBundleCamera.cy_px - T(o.v_px)) / sigma;
    residual[2] =
        o.disparity_px < 0
            ? T(0)
            : (kBundleCamera.fx_px * kBundleCamera.baseline_m / p[2] - T(o.disparity_px)) /
                  (sigma * testing::disparity_sigma_px(kBundleCamera));
    return true;
  }
};

/// Ceres' minimum of Huber's cost (twice its own, which is halved by definition).
double ceres_minimum(const BundleProblem& start) {
  const BundleConfig gates;
  std::vector<std::array<double, 6>> poses;
  for (const SE3& pose : start.camera_from_world) {
    const Eigen::Vector3d r = so3_log(pose.rotation());
    const Eigen::Vector3d& t = pose.translation();
    poses.push_back({r.x(), r.y(), r.z(), t.x(), t.y(), t.z()});
  }
  std::vector<Eigen::Vector3d> points = start.points_in_world;
  ceres::Problem problem;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    problem.AddParameterBlock(poses[i].data(), 6);
    if (i >= start.free_poses) problem.SetParameterBlockConstant(poses[i].data());
  }
  for (const BundleObservation& o : start.observations)
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<CeresCost, 3, 6, 3>(new CeresCost{o}),
        new ceres::HuberLoss(std::sqrt(o.disparity_px < 0 ? gates.chi2_mono : gates.chi2_stereo)),
        poses[o.pose].data(), points[o.point].data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  EXPECT_TRUE(summary.IsSolutionUsable());
  return 2.0 * summary.final_cost;
}

double worst_pose_m(const std::vector<SE3>& a, const std::vector<SE3>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    worst = std::max({worst, testing::distance_m(a[i], b[i]), angle_between_rad(a[i], b[i])});
  return worst;
}

TEST(Adjust, RecoversTruthWithoutNoise) {
  const SyntheticBundle bundle =
      make_bundle({.poses = 6, .points = 200, .noise_px = 0, .disturbance_m = 0.1}, kBundleCamera,
                  RandomStream(1));
  ASSERT_GT(worst_pose_m(bundle.problem.camera_from_world, bundle.true_poses), 0.05);
  // Pixels are stored as float: half a unit in the last place at 300 px is 1.5e-5 px, about 1e-7 m
  // at 3 m and 525 px; averaged over 100 observations the error is smaller than that.
  const BundleResult result =
      adjust(bundle.problem, kBundleCamera, {.iterations = 20, .refine_iterations = 10});
  EXPECT_LT(worst_pose_m(result.camera_from_world, bundle.true_poses), 1e-7);
  double worst = 0;
  for (std::size_t i = 0; i < bundle.true_points.size(); ++i)
    worst = std::max(worst, (result.points_in_world[i] - bundle.true_points[i]).norm());
  // A single point has only four observations, and a disparity of 13 px has a rounding error
  // (float) of 5e-7 px.
  EXPECT_LT(worst, 1e-6);
  EXPECT_GT(result.initial_cost, 1e4);
  EXPECT_LT(result.final_cost, 1e-6);
  for (const std::uint8_t outlier : result.outlier) EXPECT_FALSE(outlier);
}

TEST(Adjust, RecoversTruthFromPixelsAloneWithTwoFixedPoses) {
  const SyntheticBundle bundle = make_bundle({.poses = 6,
                                              .fixed_poses = 2,
                                              .points = 200,
                                              .observations_per_point = 6,
                                              .depth_share = 0,
                                              .noise_px = 0,
                                              .disturbance_m = 0.05},
                                             kBundleCamera, RandomStream(2));
  const BundleResult result =
      adjust(bundle.problem, kBundleCamera, {.iterations = 30, .refine_iterations = 10});
  // The scale now comes from the 0.24 m between the fixed poses: that is ten times less accurate
  // than with depth.
  EXPECT_LT(worst_pose_m(result.camera_from_world, bundle.true_poses), 1e-6);
}

class AdjustAgainstCeres : public ::testing::TestWithParam<double> {};

TEST_P(AdjustAgainstCeres, ReachesTheSameMinimum) {
  SyntheticBundle bundle =
      make_bundle({.poses = 8, .fixed_poses = 2, .points = 300, .depth_share = GetParam()},
                  kBundleCamera, RandomStream(3));
  // Every twentieth pixel is wrong by up to 40 px, so that Huber's loss matters.
  const RandomStream wrong(4);
  for (std::size_t i = 0; i < bundle.problem.observations.size(); i += 20)
    bundle.problem.observations[i].u_px += static_cast<float>(wrong.uniform(i, -40, 40));
  const BundleResult result =
      adjust(bundle.problem, kBundleCamera,
             {.iterations = 100, .refine_iterations = 0, .relative_decrease = 1e-10});
  const double ours = huber_cost(bundle.problem, result.camera_from_world, result.points_in_world);
  const double oracle = ceres_minimum(bundle.problem);
  EXPECT_GT(oracle, 100.0);
  EXPECT_NEAR(ours, oracle, 1e-6 * oracle) << result.iterations;
  EXPECT_NEAR(
      result.initial_cost,
      huber_cost(bundle.problem, bundle.problem.camera_from_world, bundle.problem.points_in_world),
      1e-9 * result.initial_cost);
}

INSTANTIATE_TEST_SUITE_P(ShareOfDepth, AdjustAgainstCeres, ::testing::Values(1.0, 0.7, 0.0));

TEST(Adjust, FindsTheOutliersAndIsNotMovedByThem) {
  SyntheticBundle bundle = make_bundle({.poses = 8, .points = 300, .observations_per_point = 6},
                                       kBundleCamera, RandomStream(5));
  const BundleResult clean = adjust(bundle.problem, kBundleCamera);
  std::vector<std::uint8_t> wrong(bundle.problem.observations.size(), 0);
  for (std::size_t i = 0; i < wrong.size(); i += 10) {
    bundle.problem.observations[i].u_px += i % 20 ? 60.0F : -60.0F;
    wrong[i] = 1;
  }
  const BundleResult result = adjust(bundle.problem, kBundleCamera);
  int good_rejected = 0;
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    if (wrong[i]) {
      EXPECT_TRUE(result.outlier[i]) << i;
    } else {
      good_rejected += result.outlier[i];
    }
  }
  // The gates reject 5 % of Gaussian residuals, fewer after the fit.
  EXPECT_LT(good_rejected, 0.06 * static_cast<double>(wrong.size()));
  // A tenth of gross errors adds no more error than the noise alone causes.
  EXPECT_LT(worst_pose_m(result.camera_from_world, bundle.true_poses),
            2 * worst_pose_m(clean.camera_from_world, bundle.true_poses));
  double inliers = 0;
  for (std::size_t i = 0; i < wrong.size(); ++i)
    if (!result.outlier[i])
      inliers +=
          chi2_of(bundle.problem.observations[i], result.camera_from_world, result.points_in_world);
  EXPECT_NEAR(result.final_cost, inliers, 1e-9 * inliers);
}

// Huber's cost limits the pull of a gross error, and the second phase removes it: without noise,
// the result is the truth, which the first phase does not reach, no matter how long it runs.
TEST(Adjust, TheSecondPhaseForgetsTheOutliersThatTheFirstHasBorne) {
  SyntheticBundle bundle =
      make_bundle({.poses = 6, .points = 200, .observations_per_point = 6, .noise_px = 0},
                  kBundleCamera, RandomStream(10));
  for (std::size_t i = 0; i < bundle.problem.observations.size(); i += 10)
    bundle.problem.observations[i].u_px += 60;  // all in the same direction
  const auto error_m = [&](const BundleConfig& config) {
    return worst_pose_m(adjust(bundle.problem, kBundleCamera, config).camera_from_world,
                        bundle.true_poses);
  };
  EXPECT_GT(error_m({.iterations = 100, .refine_iterations = 0, .relative_decrease = 0}), 1e-4);
  EXPECT_LT(error_m({.iterations = 20, .refine_iterations = 10}), 1e-6);
  const BundleResult result =
      adjust(bundle.problem, kBundleCamera, {.iterations = 20, .refine_iterations = 10});
  EXPECT_LT(result.final_cost, 1e-6) << "the sum over the inliers";
  // The trial steps of both phases are reported.
  const auto steps = [&](int refine_iterations) {
    return adjust(bundle.problem, kBundleCamera,
                  {.iterations = 1, .refine_iterations = refine_iterations, .relative_decrease = 0})
        .iterations;
  };
  EXPECT_EQ(steps(0), 1);
  EXPECT_EQ(steps(1), 2);
  EXPECT_EQ(steps(2), 3);
}

TEST(Adjust, MovesNeitherFixedPosesNorWhatNobodyDetermines) {
  SyntheticBundle bundle =
      make_bundle({.poses = 6, .fixed_poses = 2, .points = 100}, kBundleCamera, RandomStream(6));
  BundleProblem& problem = bundle.problem;
  // One point loses its depth and all observations but the first; one more loses all of them.
  std::erase_if(problem.observations, [seen = false](const BundleObservation& o) mutable {
    if (o.point == 41) return true;
    if (o.point != 40) return false;
    return std::exchange(seen, true);
  });
  for (BundleObservation& o : problem.observations)
    if (o.point == 40) o.disparity_px = -1;
  // A free pose that sees nothing, inserted as the last free one.
  problem.camera_from_world.insert(problem.camera_from_world.begin() + 4, testing::true_pose());
  ++problem.free_poses;
  for (BundleObservation& o : problem.observations) o.pose += o.pose >= 4;

  const BundleResult result = adjust(problem, kBundleCamera);
  EXPECT_LT(result.final_cost, 0.5 * result.initial_cost);
  for (std::size_t i = 5; i < 7; ++i) {
    EXPECT_EQ(result.camera_from_world[i].rotation(), problem.camera_from_world[i].rotation());
    EXPECT_EQ(result.camera_from_world[i].translation(),
              problem.camera_from_world[i].translation());
  }
  // Although the pose is free, nothing moves it: its rotation is only orthonormalized again.
  EXPECT_LT(testing::distance_m(result.camera_from_world[4], problem.camera_from_world[4]), 1e-12);
  EXPECT_EQ(result.points_in_world[40], problem.points_in_world[40]);
  EXPECT_EQ(result.points_in_world[41], problem.points_in_world[41]);
}

TEST(Adjust, AMotionPlacesAPoseThatSeesNothing) {
  SyntheticBundle bundle =
      make_bundle({.poses = 6, .fixed_poses = 2, .points = 100}, kBundleCamera, RandomStream(6));
  BundleProblem& problem = bundle.problem;
  const SE3 unseen = testing::true_pose();
  problem.camera_from_world.insert(problem.camera_from_world.begin() + 4, unseen);
  ++problem.free_poses;
  for (BundleObservation& o : problem.observations) o.pose += o.pose >= 4;
  // Off by 0.3 m and 0.2 rad from where the motion from a fixed pose puts it.
  Vector6d off;
  off << 0.3, 0, 0, 0, 0.2, 0;
  const SE3 told = SE3::exp(off) * unseen;
  problem.motions.push_back({.a = 5,
                             .b = 4,
                             .b_from_a = told * problem.camera_from_world[5].inverse(),
                             .sigma_m = 0.02,
                             .sigma_rad = 0.02});
  const BundleResult result = adjust(problem, kBundleCamera, {.iterations = 50});
  EXPECT_LT((result.camera_from_world[4] * told.inverse()).log().norm(), 1e-3);
}

TEST(Adjust, AMotionBetweenFreePosesHoldsThemTogetherAndASlipDoesNot) {
  const auto moved_by = [](double slip_m, double sigma) {
    SyntheticBundle bundle = make_bundle({.poses = 6, .points = 300, .disturbance_m = 0.01},
                                         kBundleCamera, RandomStream(7));
    const BundleResult before = adjust(bundle.problem, kBundleCamera);
    Vector6d slip = Vector6d::Zero();
    slip[0] = slip_m;
    for (const auto& [a, b] : {std::pair(0U, 1U), std::pair(3U, 2U)})
      bundle.problem.motions.push_back(
          {.a = a,
           .b = b,
           .b_from_a = SE3::exp(slip) * bundle.true_poses[b] * bundle.true_poses[a].inverse(),
           .sigma_m = sigma,
           .sigma_rad = sigma});
    const BundleResult after = adjust(bundle.problem, kBundleCamera);
    double error_before = 0, error_after = 0;
    for (const auto& [a, b] : {std::pair(0U, 1U), std::pair(3U, 2U)}) {
      const SE3 truth = bundle.true_poses[b] * bundle.true_poses[a].inverse();
      const auto error = [&](const BundleResult& r) {
        return (r.camera_from_world[b] * r.camera_from_world[a].inverse() * truth.inverse())
            .log()
            .norm();
      };
      error_before += error(before);
      error_after += error(after);
    }
    return error_after / error_before;
  };
  EXPECT_LT(moved_by(0, 1e-4), 0.3);
  EXPECT_LT(moved_by(1.0, 0.01), 3) << "a meter's slip counts little";
}

TEST(Adjust, DropsAnObservationFromBehindTheCamera) {
  SyntheticBundle bundle =
      make_bundle({.poses = 6, .points = 150, .noise_px = 0}, kBundleCamera, RandomStream(7));
  BundleProblem& problem = bundle.problem;
  const BundleObservation first = problem.observations.front();
  // The start puts the point behind all cameras: nothing pulls it forward.
  problem.points_in_world[first.point] = Eigen::Vector3d(0, 0, -50);
  const BundleResult result =
      adjust(problem, kBundleCamera, {.iterations = 20, .refine_iterations = 10});
  for (std::size_t i = 0; i < problem.observations.size(); ++i)
    EXPECT_EQ(result.outlier[i], problem.observations[i].point == first.point) << i;
  EXPECT_LT(worst_pose_m(result.camera_from_world, bundle.true_poses), 1e-7);
}

TEST(Adjust, AcceptsAnEmptyProblemAndOneWithoutFreePoses) {
  const BundleResult empty = adjust({}, kBundleCamera);
  EXPECT_EQ(empty.final_cost, 0);
  const SyntheticBundle bundle = make_bundle(
      {.poses = 4, .fixed_poses = 4, .points = 50, .noise_px = 0}, kBundleCamera, RandomStream(8));
  const BundleResult result =
      adjust(bundle.problem, kBundleCamera, {.iterations = 20, .refine_iterations = 10});
  for (std::size_t i = 0; i < bundle.true_points.size(); ++i)
    EXPECT_LT((result.points_in_world[i] - bundle.true_points[i]).norm(), 1e-6);
}

TEST(Adjust, GivesTheSameBitsTwice) {
  const SyntheticBundle bundle = make_bundle({.points = 200}, kBundleCamera, RandomStream(9));
  const BundleResult a = adjust(bundle.problem, kBundleCamera);
  const BundleResult b = adjust(bundle.problem, kBundleCamera);
  EXPECT_EQ(a.points_in_world, b.points_in_world);
  for (std::size_t i = 0; i < a.camera_from_world.size(); ++i) {
    EXPECT_EQ(a.camera_from_world[i].rotation(), b.camera_from_world[i].rotation());
    EXPECT_EQ(a.camera_from_world[i].translation(), b.camera_from_world[i].translation());
  }
  EXPECT_EQ(a.final_cost, b.final_cost);
  EXPECT_EQ(a.outlier, b.outlier);
}

}  // namespace
}  // namespace mh
