// SPDX-License-Identifier: Apache-2.0
#include "slam/optimize/reprojection.hpp"

#include <gtest/gtest.h>

#include "tests/slam/optimize/synthetic.hpp"

namespace mh {
namespace {

// Central differences with steps h have errors of about h^2 f''' + eps f / h: for residuals of
// about 100 px and h = 1e-6, that is 1e-8 of the Jacobian's 500 px/m.
constexpr double kStep = 1e-6;
constexpr double kTolerance = 1e-5;

const Camera kReprojectionCamera{};
const Eigen::Vector3d kPoints[] = {{0.3, -0.4, 1.7}, {-1.2, 0.8, 3.5}, {0.01, 0.0, 0.6}};

ImageMeasurement measured(bool depth) {
  return {.u_px = 301.5, .v_px = 222.25, .disparity_px = depth ? 14.5 : -1.0, .sigma_px = 1.7};
}

TEST(Reprojection, PointJacobianEqualsCentralDifferences) {
  for (const bool depth : {false, true}) {
    const ImageMeasurement m = measured(depth);
    for (const Eigen::Vector3d& p : kPoints) {
      const Eigen::Matrix3d analytic = reprojection_jacobian(p, m, kReprojectionCamera);
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d h = kStep * Eigen::Vector3d::Unit(k);
        const Eigen::Vector3d numeric = (reprojection_residual(p + h, m, kReprojectionCamera) -
                                         reprojection_residual(p - h, m, kReprojectionCamera)) /
                                        (2 * kStep);
        EXPECT_LT((analytic.col(k) - numeric).norm(), kTolerance);
      }
      EXPECT_EQ(analytic.row(2).isZero(0), !depth);
    }
  }
}

TEST(Reprojection, PoseJacobianEqualsCentralDifferences) {
  const SE3 pose = testing::true_pose();
  for (const bool depth : {false, true}) {
    const ImageMeasurement m = measured(depth);
    for (const Eigen::Vector3d& p : kPoints) {
      const Eigen::Vector3d point_in_world = pose.inverse() * p;
      const Eigen::Matrix<double, 3, 6> analytic =
          reprojection_jacobian(p, m, kReprojectionCamera) * perturbation_jacobian(p);
      for (int k = 0; k < 6; ++k) {
        const Vector6d h = kStep * Vector6d::Unit(k);
        const Eigen::Vector3d plus =
            reprojection_residual(SE3::exp(h) * pose * point_in_world, m, kReprojectionCamera);
        const Eigen::Vector3d minus =
            reprojection_residual(SE3::exp(-h) * pose * point_in_world, m, kReprojectionCamera);
        EXPECT_LT((analytic.col(k) - (plus - minus) / (2 * kStep)).norm(), kTolerance);
      }
    }
  }
}

TEST(Reprojection, WorldPointJacobianEqualsCentralDifferences) {
  const SE3 pose = testing::true_pose();
  const ImageMeasurement m = measured(true);
  for (const Eigen::Vector3d& p : kPoints) {
    const Eigen::Vector3d point = pose.inverse() * p;
    const Eigen::Matrix3d analytic =
        reprojection_jacobian(p, m, kReprojectionCamera) * pose.rotation();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d h = kStep * Eigen::Vector3d::Unit(k);
      const Eigen::Vector3d numeric =
          (reprojection_residual(pose * (point + h), m, kReprojectionCamera) -
           reprojection_residual(pose * (point - h), m, kReprojectionCamera)) /
          (2 * kStep);
      EXPECT_LT((analytic.col(k) - numeric).norm(), kTolerance);
    }
  }
}

TEST(Reprojection, CameraFrameTermIsTheProductOfJacobians) {
  for (const bool depth : {false, true}) {
    const ImageMeasurement m = measured(depth);
    for (const Eigen::Vector3d& p : kPoints) {
      const Eigen::Vector3d r = reprojection_residual(p, m, kReprojectionCamera);
      const Eigen::Matrix3d j = reprojection_jacobian(p, m, kReprojectionCamera);
      const CameraFrameTerm term = camera_frame_term(p, r, 0.6, m, kReprojectionCamera);
      const Eigen::Matrix3d information = 0.6 * j.transpose() * j;
      const Eigen::Vector3d gradient = 0.6 * j.transpose() * r;
      EXPECT_LT((term.information - information).norm(), 1e-12 * information.norm());
      EXPECT_LT((term.gradient - gradient).norm(), 1e-12 * gradient.norm());
      EXPECT_LT((cross_columns(p, information) - hat(p) * information).norm(),
                1e-12 * information.norm());
    }
  }
}

TEST(Huber, WeightIsTheDerivativeOfTheLoss) {
  constexpr double kGate = 5.991;
  for (const double chi2 : {0.5, 5.0, 7.0, 400.0}) {
    const double h = 1e-6 * chi2;
    const double numeric = (huber_loss(chi2 + h, kGate) - huber_loss(chi2 - h, kGate)) / (2 * h);
    EXPECT_NEAR(huber_weight(chi2, kGate), numeric, 1e-8);
  }
  EXPECT_DOUBLE_EQ(huber_loss(kGate, kGate), kGate);
}

}  // namespace
}  // namespace mh
