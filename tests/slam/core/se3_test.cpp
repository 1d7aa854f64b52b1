// SPDX-License-Identifier: Apache-2.0
#include "slam/core/se3.hpp"

#include <gtest/gtest.h>

#include "slam/core/random.hpp"

namespace mh {
namespace {

Vector6d random_tangent(RandomStream stream, double scale) {
  Vector6d tangent;
  for (int i = 0; i < 6; ++i) tangent[i] = stream.uniform(i, -scale, scale);
  return tangent;
}

TEST(Se3, LogInvertsExpFromTinyToLargeAngles) {
  for (const double scale : {1e-9, 1e-6, 1e-3, 0.5, 1.7})
    for (int i = 0; i < 50; ++i) {
      const Vector6d tangent = random_tangent(RandomStream(1).fork(i), scale);
      EXPECT_LT((SE3::exp(tangent).log() - tangent).norm(), 1e-9 * (1 + scale)) << scale;
    }
}

TEST(Se3, InverseAndProductAreGroupOperations) {
  for (int i = 0; i < 50; ++i) {
    const SE3 a = SE3::exp(random_tangent(RandomStream(2).fork(i), 2.0));
    const SE3 b = SE3::exp(random_tangent(RandomStream(3).fork(i), 2.0));
    const Eigen::Vector3d p(1, -2, 3);
    EXPECT_LT(((a * b) * p - a * (b * p)).norm(), 1e-12);
    EXPECT_LT((a.inverse() * (a * p) - p).norm(), 1e-12);
  }
}

TEST(Se3, LogIsStableAtHalfATurn) {
  const Eigen::Vector3d phi = Eigen::Vector3d(1, 2, -1).normalized() * (M_PI - 1e-9);
  EXPECT_LT((so3_log(so3_exp(phi)) - phi).norm(), 1e-7);
}

TEST(Se3, AngleBetweenIsTheRotationAngle) {
  const SE3 a = SE3::exp(random_tangent(RandomStream(4), 1.0));
  const SE3 b = a * SE3(so3_exp({0, 0, 0.3}), {1, 2, 3});
  EXPECT_NEAR(angle_between_rad(a, b), 0.3, 1e-12);
}

}  // namespace
}  // namespace mh
