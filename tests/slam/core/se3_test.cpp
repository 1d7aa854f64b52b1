// SPDX-License-Identifier: Apache-2.0
#include "slam/core/se3.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "slam/core/random.hpp"

namespace mh {
namespace {

Vector6d random_tangent(RandomStream stream, double scale) {
  Vector6d tangent;
  for (int i = 0; i < 6; ++i) tangent[i] = stream.uniform(i, -scale, scale);
  return tangent;
}

using Matrix3l = Eigen::Matrix<long double, 3, 3>;

/// The power series sum of hat(phi)^k / (k + first)! in extended precision, without any special
/// case for angles: first = 0 gives exp, first = 1 gives V for the translation.
Matrix3l power_series(const Eigen::Vector3d& phi, int first) {
  const Matrix3l skew = hat(phi).cast<long double>();
  Matrix3l sum = Matrix3l::Identity(), term = Matrix3l::Identity();
  for (int k = 1; k <= 40; ++k) {
    term = term * skew / static_cast<long double>(k + first);
    sum += term;
  }
  return sum;
}

/// Angles on both sides of the switch from series to closed form, and far from it.
constexpr double kAngles_rad[] = {
    0,    1e-12, 1e-8, 3e-6, 9.999e-6, 1e-5 * (1 - 1e-12), 1e-5, 1e-5 * (1 + 1e-12), 1.001e-5,
    1e-4, 1e-2,  0.7,  2.0,  3.1};

// The axes have no zero component, so each entry of both matrices matters. Tolerance: a few units
// in the last place of 1. In the closed form of the rotation, (1 - cos) / angle^2 suffers from
// cancellation, but its error of half a unit is divided by angle^2 and then multiplied by it again.
TEST(Se3, ExpIsItsPowerSeriesOnBothSidesOfTheSwitch) {
  for (const double angle_rad : kAngles_rad)
    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d(1, -2, 0.5), Eigen::Vector3d(-0.3, 0.2, 1)}) {
      const Eigen::Vector3d phi = angle_rad * axis.normalized();
      const Matrix3l error = so3_exp(phi).cast<long double>() - power_series(phi, 0);
      EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-15L) << angle_rad;
    }
}

// V's closed form divides 1 - cos, which suffers from cancellation, by angle^2 and multiplies it by
// the angle only once: at 1e-5 rad its error is 1e-16 / 1e-5 = 1e-11, while its second-order term
// is 1.7e-11. The bound below therefore includes the largest error that cancellation can cause.
TEST(Se3, TranslationOfExpIsItsPowerSeriesOnBothSidesOfTheSwitch) {
  const Eigen::Vector3d rho(0.7, -1.1, 0.4);
  for (const double angle_rad : kAngles_rad)
    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d(1, -2, 0.5), Eigen::Vector3d(-0.3, 0.2, 1)}) {
      const Eigen::Vector3d phi = angle_rad * axis.normalized();
      Vector6d tangent;
      tangent.head<3>() = rho;
      tangent.tail<3>() = phi;
      const Eigen::Matrix<long double, 3, 1> error =
          SE3::exp(tangent).translation().cast<long double>() -
          power_series(phi, 1) * rho.cast<long double>();
      const double bound = angle_rad < 1e-5 ? 1e-15 : 1e-15 + 2e-16 / angle_rad;
      EXPECT_LT(error.cwiseAbs().maxCoeff(), bound) << angle_rad;
    }
}

// The rotation is made with the power series, so that an error in so3_exp cannot hide one here.
TEST(Se3, LogUndoesThePowerSeriesOnBothSidesOfTheSwitch) {
  const Eigen::Vector3d rho(0.7, -1.1, 0.4);
  for (const double angle_rad : kAngles_rad)
    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d(1, -2, 0.5), Eigen::Vector3d(-0.3, 0.2, 1)}) {
      const Eigen::Vector3d phi = angle_rad * axis.normalized();
      const Eigen::Matrix3d rotation = power_series(phi, 0).cast<double>();
      const Eigen::Vector3d translation =
          (power_series(phi, 1) * rho.cast<long double>()).cast<double>();
      EXPECT_LT((so3_log(rotation) - phi).norm(), 2e-15) << angle_rad;
      const Vector6d tangent = SE3(rotation, translation).log();
      const double bound = angle_rad < 1e-5 ? 2e-15 : 4e-15 + 1e-15 / angle_rad;
      EXPECT_LT((tangent.head<3>() - rho).norm(), bound) << angle_rad;
      EXPECT_LT((tangent.tail<3>() - phi).norm(), 2e-15) << angle_rad;
    }
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
