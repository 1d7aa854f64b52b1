// SPDX-License-Identifier: Apache-2.0
#include "slam/optimize/pose_system.hpp"

#include <gtest/gtest.h>

#include "slam/core/random.hpp"
#include "slam/optimize/bundle.hpp"
#include "tests/slam/optimize/bundle_problem.hpp"

namespace mh {
namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// A band of couplings and some outside it: J^T J of random blocks, so it is positive definite.
struct Random {
  PoseSystem system;
  Eigen::MatrixXd matrix;
};

Random random_system(std::uint32_t poses) {
  Pairs pairs;
  for (std::uint32_t i = 0; i + 1 < poses; ++i) pairs.emplace_back(i, i + 1);
  for (std::uint32_t i = 0; i + 40 < poses; i += 9) pairs.emplace_back(i + 40, i);
  Random r{PoseSystem(poses, pairs), Eigen::MatrixXd::Identity(6 * poses, 6 * poses)};
  r.system.set_zero();
  for (std::uint32_t i = 0; i < poses; ++i) r.system.at(i, i).setIdentity();
  std::uint64_t draw = 0;
  const RandomStream random(1);
  for (const auto& [a, b] : pairs) {
    Eigen::Matrix<double, 4, 12> jacobian;
    for (Eigen::Index k = 0; k < jacobian.size(); ++k)
      jacobian.data()[k] = random.uniform(draw++, -1, 1);
    const auto low = std::min(a, b), high = std::max(a, b);
    const Eigen::Matrix<double, 12, 12> product = jacobian.transpose() * jacobian;
    r.system.at(low, low) += product.topLeftCorner<6, 6>();
    r.system.at(high, high) += product.bottomRightCorner<6, 6>();
    r.system.at(high, low) += product.bottomLeftCorner<6, 6>();
    r.matrix.block<6, 6>(6 * low, 6 * low) += product.topLeftCorner<6, 6>();
    r.matrix.block<6, 6>(6 * high, 6 * high) += product.bottomRightCorner<6, 6>();
    r.matrix.block<6, 6>(6 * high, 6 * low) += product.bottomLeftCorner<6, 6>();
    r.matrix.block<6, 6>(6 * low, 6 * high) += product.topRightCorner<6, 6>();
  }
  return r;
}

class PoseSystemOfSize : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(PoseSystemOfSize, SolvesWhatADenseSolverSolves) {
  Random r = random_system(GetParam());
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(r.matrix.rows(), -1, 2);
  const Eigen::VectorXd expected = r.matrix.llt().solve(x);
  ASSERT_TRUE(r.system.solve(x));
  EXPECT_LT((x - expected).norm(), 1e-7 * expected.norm());
}

TEST_P(PoseSystemOfSize, RefusesWhatIsNotPositiveDefinite) {
  Random r = random_system(GetParam());
  r.system.at(3, 3)(2, 2) = -1.0;
  Eigen::VectorXd x = Eigen::VectorXd::Ones(r.matrix.rows());
  EXPECT_FALSE(r.system.solve(x));
}

INSTANTIATE_TEST_SUITE_P(DirectAndIterative, PoseSystemOfSize,
                         ::testing::Values(5U, PoseSystem::kDirectPoses,
                                           PoseSystem::kDirectPoses + 1, 400U));

TEST(Adjust, ManyPosesFindTheTruthAsFewDo) {
  testing::BundleShape shape;
  shape.poses = PoseSystem::kDirectPoses + 40;
  shape.fixed_poses = 2;
  shape.points = 6000;
  shape.noise_px = 0;
  shape.disturbance_m = 0.005;
  const Camera camera;
  const auto bundle = testing::make_bundle(shape, camera, RandomStream(1));
  const BundleResult result =
      adjust(bundle.problem, camera, {.iterations = 20, .relative_decrease = 1e-9});
  EXPECT_LT(result.final_cost, 1e-6 * result.initial_cost);
  for (std::size_t i = 0; i < bundle.true_poses.size(); ++i)
    EXPECT_LT((result.camera_from_world[i] * bundle.true_poses[i].inverse()).log().norm(), 1e-4)
        << i;
}

}  // namespace
}  // namespace mh
