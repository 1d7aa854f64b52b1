// SPDX-License-Identifier: Apache-2.0
#include "slam/optimize/pose.hpp"

#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "tests/slam/optimize/synthetic.hpp"

namespace mh {
namespace {

using testing::add_noise;
using testing::distance_m;
using testing::make_outliers;
using testing::observe;
using testing::ten_centimeters_and_five_degrees;
using testing::true_pose;

const Camera kCamera{};

bool same_bits(const SE3& a, const SE3& b) {
  return std::memcmp(a.rotation().data(), b.rotation().data(), 9 * sizeof(double)) == 0 &&
         std::memcmp(a.translation().data(), b.translation().data(), 3 * sizeof(double)) == 0;
}

TEST(EstimatePose, RecoversTheExactPoseWithoutNoise) {
  const SE3 truth = true_pose();
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const auto observations = observe(60, truth, kCamera, RandomStream(seed));
    const auto estimate =
        estimate_pose(observations, ten_centimeters_and_five_degrees(truth), kCamera);
    ASSERT_TRUE(estimate);
    EXPECT_LT(distance_m(estimate->camera_from_world, truth), 1e-9);
    EXPECT_LT(angle_between_rad(estimate->camera_from_world, truth), 1e-9);
    EXPECT_EQ(estimate->inlier_count, 60);
  }
}

TEST(EstimatePose, RecoversTruthFromPixelsAlone) {
  const SE3 truth = true_pose();
  auto observations = observe(60, truth, kCamera, RandomStream(1));
  for (PoseObservation& o : observations) o.disparity_px = -1;
  const auto estimate =
      estimate_pose(observations, ten_centimeters_and_five_degrees(truth), kCamera);
  ASSERT_TRUE(estimate);
  EXPECT_LT(distance_m(estimate->camera_from_world, truth), 1e-9);
}

TEST(EstimatePose, RecoversTruthWithThirtyPercentOutliers) {
  const SE3 truth = true_pose();
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RandomStream stream(seed);
    auto observations = observe(200, truth, kCamera, stream.fork(0));
    add_noise(observations, kCamera, stream.fork(1));
    make_outliers(observations, 60, kCamera, stream.fork(2));
    const auto estimate =
        estimate_pose(observations, ten_centimeters_and_five_degrees(truth), kCamera);
    ASSERT_TRUE(estimate) << seed;
    // 140 points at 1.5 px and 3 m: 1.5 px / 525 px * 3 m / sqrt(140) is below 1 mm along each
    // axis; 1 cm leaves room for the weaker directions, where rotation and translation compensate
    // for each other.
    EXPECT_LT(distance_m(estimate->camera_from_world, truth), 0.01) << seed;
    EXPECT_LT(angle_between_rad(estimate->camera_from_world, truth), 0.003) << seed;
    for (std::size_t i = 0; i < 60; ++i) EXPECT_FALSE(estimate->inlier[i]) << seed << ' ' << i;
    // The gates keep 95 %; the probability of fewer than 122 of 140 (87 %) is below 1e-4.
    EXPECT_GE(estimate->inlier_count, 122) << seed;
  }
}

TEST(EstimatePose, ItsInformationIsTheInverseCovarianceOfItsErrors) {
  constexpr int kViews = 300;
  const SE3 truth = true_pose();
  PoseConfig every;  // the gates would cut the tails off
  every.chi2_mono = every.chi2_stereo = 1e6;
  double squared = 0;
  for (std::uint64_t seed = 0; seed < kViews; ++seed) {
    const RandomStream stream(seed);
    auto observations = observe(80, truth, kCamera, stream.fork(0));
    add_noise(observations, kCamera, stream.fork(1));
    const auto estimate = estimate_pose(observations, truth, kCamera, every);
    ASSERT_TRUE(estimate);
    const Vector6d error = (estimate->camera_from_world * truth.inverse()).log();
    squared += error.dot(estimate->information * error) / kViews;
  }
  // Chi-square with 6 degrees of freedom has a mean of 6; the mean of 300 samples has a standard
  // error of 0.2.
  EXPECT_NEAR(squared, 6, 0.6);
}

TEST(EstimatePose, CountsItsInliersAndRejectsPointsBehindTheCamera) {
  const SE3 truth = true_pose();
  auto observations = observe(50, truth, kCamera, RandomStream(4));
  // A point mirrored through the camera's center has the same pixel.
  for (std::size_t i = 0; i < 8; ++i) {
    observations[i].point_in_world =
        truth.inverse() * Eigen::Vector3d(-(truth * observations[i].point_in_world));
    observations[i].disparity_px = -1;
  }
  const auto estimate = estimate_pose(observations, truth, kCamera);
  ASSERT_TRUE(estimate);
  EXPECT_EQ(estimate->inlier_count, 42);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ(estimate->inlier[i], i >= 8) << i;
  EXPECT_LT(distance_m(estimate->camera_from_world, truth), 1e-9);
}

TEST(EstimatePose, GivesNothingWhereNothingCanBeKnown) {
  const SE3 truth = true_pose();
  const auto observations = observe(40, truth, kCamera, RandomStream(5));
  EXPECT_FALSE(estimate_pose({}, truth, kCamera));
  EXPECT_FALSE(estimate_pose(std::span(observations).first(9), truth, kCamera));
  EXPECT_TRUE(estimate_pose(std::span(observations).first(10), truth, kCamera));

  // Points on a line leave the rotation about it free.
  auto line = observations;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector3d p(-1.0 + 0.05 * static_cast<double>(i), 0.2, 3.0);
    const Eigen::Vector2d pixel = kCamera.project(p);
    line[i] = {.point_in_world = truth.inverse() * p, .u_px = pixel.x(), .v_px = pixel.y()};
  }
  EXPECT_FALSE(estimate_pose(line, truth, kCamera));

  // Nothing fits: the pixels are random.
  auto noise = observations;
  make_outliers(noise, 40, kCamera, RandomStream(6));
  EXPECT_FALSE(estimate_pose(noise, truth, kCamera));

  auto invalid = observations;
  invalid[3].u_px = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(estimate_pose(invalid, truth, kCamera));

  const SE3 facing_away = SE3::exp(testing::tangent(0, 0, 0, 0, 3.14, 0)) * truth;
  EXPECT_FALSE(estimate_pose(observations, facing_away, kCamera));
}

TEST(EstimatePose, GivesTheSameBitsTwice) {
  const SE3 truth = true_pose();
  auto observations = observe(150, truth, kCamera, RandomStream(7));
  add_noise(observations, kCamera, RandomStream(8));
  const auto a = estimate_pose(observations, truth, kCamera);
  const auto b = estimate_pose(observations, truth, kCamera);
  ASSERT_TRUE(a && b);
  EXPECT_TRUE(same_bits(a->camera_from_world, b->camera_from_world));
  EXPECT_EQ(a->inlier, b->inlier);
}

TEST(SolvePnpRansac, FindsThePoseAmongFiftyPercentOutliers) {
  const SE3 truth = true_pose();
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RandomStream stream(seed);
    auto observations = observe(100, truth, kCamera, stream.fork(0));
    add_noise(observations, kCamera, stream.fork(1));
    make_outliers(observations, 50, kCamera, stream.fork(2));
    const auto estimate = solve_pnp_ransac(observations, kCamera, {}, {}, stream.fork(3));
    ASSERT_TRUE(estimate) << seed;
    // Bounds as above, for 50 points instead of 140.
    EXPECT_LT(distance_m(estimate->camera_from_world, truth), 0.02) << seed;
    EXPECT_LT(angle_between_rad(estimate->camera_from_world, truth), 0.006) << seed;
    for (std::size_t i = 0; i < 50; ++i) EXPECT_FALSE(estimate->inlier[i]) << seed << ' ' << i;
    EXPECT_GE(estimate->inlier_count, 38) << seed;
  }
}

// If no observation is wrong, any three different ones give the pose at once.
TEST(SolvePnpRansac, WithoutOutliersOneDrawIsEnough) {
  const SE3 truth = true_pose();
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto observations = observe(10, truth, kCamera, RandomStream(seed).fork(0));
    const auto estimate = solve_pnp_ransac(observations, kCamera, {.max_iterations = 1}, {},
                                           RandomStream(seed).fork(1));
    ASSERT_TRUE(estimate) << seed;
    EXPECT_EQ(estimate->inlier_count, 10) << seed;
  }
}

// Three samples are three different points: with four, five or six exact points any three will do.
TEST(SolvePnpRansac, DrawsThreeDifferentPointsHoweverFewThereAre) {
  const SE3 truth = true_pose();
  for (const int count : {4, 5, 6})
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      const auto observations = observe(count, truth, kCamera, RandomStream(17));
      const auto estimate = solve_pnp_ransac(
          observations, kCamera, {.max_iterations = 1, .min_inliers = 4}, {}, RandomStream(seed));
      ASSERT_TRUE(estimate) << count << " " << seed;
      EXPECT_EQ(estimate->inlier_count, count);
      EXPECT_LT(distance_m(estimate->camera_from_world, truth), 1e-6);
    }
}

TEST(SolvePnpRansac, IsExactWithoutNoise) {
  const SE3 truth = true_pose();
  const auto observations = observe(30, truth, kCamera, RandomStream(9));
  const auto estimate = solve_pnp_ransac(observations, kCamera, {}, {}, RandomStream(10));
  ASSERT_TRUE(estimate);
  EXPECT_EQ(estimate->inlier_count, 30);
  EXPECT_LT(distance_m(estimate->camera_from_world, truth), 1e-9);
}

TEST(SolvePnpRansac, GivesNothingWhereNothingCanBeKnown) {
  const SE3 truth = true_pose();
  auto observations = observe(60, truth, kCamera, RandomStream(11));
  EXPECT_FALSE(solve_pnp_ransac({}, kCamera, {}, {}, RandomStream(0)));
  EXPECT_FALSE(
      solve_pnp_ransac(std::span(observations).first(9), kCamera, {}, {}, RandomStream(0)));

  auto line = observations;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector3d p(-1.0 + 0.03 * static_cast<double>(i), 0.2, 3.0);
    const Eigen::Vector2d pixel = kCamera.project(p);
    line[i] = {.point_in_world = truth.inverse() * p, .u_px = pixel.x(), .v_px = pixel.y()};
  }
  EXPECT_FALSE(solve_pnp_ransac(line, kCamera, {}, {}, RandomStream(0)));

  auto one_place = observations;
  for (PoseObservation& o : one_place) o = observations.front();
  EXPECT_FALSE(solve_pnp_ransac(one_place, kCamera, {}, {}, RandomStream(0)));

  auto invalid = observations;
  for (PoseObservation& o : invalid) o.point_in_world.x() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(solve_pnp_ransac(invalid, kCamera, {}, {}, RandomStream(0)));

  make_outliers(observations, 60, kCamera, RandomStream(12));
  EXPECT_FALSE(solve_pnp_ransac(observations, kCamera, {}, {}, RandomStream(0)));
}

TEST(SolvePnpRansac, DependsOnItsStreamAlone) {
  const SE3 truth = true_pose();
  auto observations = observe(100, truth, kCamera, RandomStream(13));
  add_noise(observations, kCamera, RandomStream(14));
  make_outliers(observations, 40, kCamera, RandomStream(15));
  const auto a = solve_pnp_ransac(observations, kCamera, {}, {}, RandomStream(16));
  solve_pnp_ransac(observations, kCamera, {}, {}, RandomStream(99));
  const auto b = solve_pnp_ransac(observations, kCamera, {}, {}, RandomStream(16));
  ASSERT_TRUE(a && b);
  EXPECT_TRUE(same_bits(a->camera_from_world, b->camera_from_world));
  EXPECT_EQ(a->inlier, b->inlier);
}

}  // namespace
}  // namespace mh
