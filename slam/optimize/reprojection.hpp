// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "slam/core/camera.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// A point nearer than this to the camera plane (or behind it) cannot have been seen: 1 cm is well
/// inside the blind zone of every depth camera and keeps 1/z far from overflow.
inline constexpr double kMinimumDepth_m = 0.01;

/// A cost at rounding level: (1e-9 sigma)^2 per observation.
inline constexpr double kPerfectChi2 = 1e-18;

/// One measurement (u, v[, disparity]) in px; disparity < 0 = no depth.
struct ImageMeasurement {
  double u_px = 0, v_px = 0;
  double disparity_px = -1;
  double sigma_px = 1;

  bool has_depth() const { return disparity_px >= 0; }
};

/// Whitened residual (prediction - measurement) / sigma of a point in the camera's frame; its third
/// element is 0 without depth. Valid for z >= kMinimumDepth_m.
inline Eigen::Vector3d reprojection_residual(const Eigen::Vector3d& point_in_camera,
                                             const ImageMeasurement& measured,
                                             const Camera& camera) {
  const double inverse_z = 1.0 / point_in_camera.z();
  const double inverse_sigma = 1.0 / measured.sigma_px;
  const double u_px = camera.fx_px * point_in_camera.x() * inverse_z + camera.cx_px;
  const double v_px = camera.fy_px * point_in_camera.y() * inverse_z + camera.cy_px;
  const double d_px = camera.fx_px * camera.baseline_m * inverse_z;
  return {(u_px - measured.u_px) * inverse_sigma, (v_px - measured.v_px) * inverse_sigma,
          measured.has_depth()
              ? (d_px - measured.disparity_px) * inverse_sigma / camera.disparity_sigma_px
              : 0.0};
}

/// Derivative of that residual with respect to the point in the camera frame; third row 0 without
/// depth.
inline Eigen::Matrix3d reprojection_jacobian(const Eigen::Vector3d& point_in_camera,
                                             const ImageMeasurement& measured,
                                             const Camera& camera) {
  const double inverse_z = 1.0 / point_in_camera.z();
  const double a = camera.fx_px * inverse_z / measured.sigma_px;
  const double b = camera.fy_px * inverse_z / measured.sigma_px;
  const double c =
      measured.has_depth() ? a * camera.baseline_m * inverse_z / camera.disparity_sigma_px : 0.0;
  Eigen::Matrix3d jacobian;
  jacobian << a, 0, -a * point_in_camera.x() * inverse_z,  //
      0, b, -b * point_in_camera.y() * inverse_z,          //
      0, 0, -c;
  return jacobian;
}

/// Derivative of p = T X with respect to a left perturbation T <- exp(delta) T: [I | -hat(p)]
/// (Barfoot 7.179).
inline Eigen::Matrix<double, 3, 6> perturbation_jacobian(const Eigen::Vector3d& point_in_camera) {
  Eigen::Matrix<double, 3, 6> jacobian;
  jacobian << Eigen::Matrix3d::Identity(), -hat(point_in_camera);
  return jacobian;
}

/// What one observation contributes for its point in the camera frame: with the residual r, its
/// Jacobian J and weight w, information = w J^T J and gradient = w J^T r. Pose and point blocks of
/// the normal equations are rotations and cross products of these, which is cheaper than
/// multiplying 3x6 Jacobians.
struct CameraFrameTerm {
  Eigen::Matrix3d information;
  Eigen::Vector3d gradient;
};

inline CameraFrameTerm camera_frame_term(const Eigen::Vector3d& point_in_camera,
                                         const Eigen::Vector3d& residual, double weight,
                                         const ImageMeasurement& measured, const Camera& camera) {
  const double inverse_z = 1.0 / point_in_camera.z();
  const double x = point_in_camera.x() * inverse_z;
  const double y = point_in_camera.y() * inverse_z;
  const double a = camera.fx_px * inverse_z / measured.sigma_px;
  const double b = camera.fy_px * inverse_z / measured.sigma_px;
  const double c =
      measured.has_depth() ? a * camera.baseline_m * inverse_z / camera.disparity_sigma_px : 0.0;
  const double waa = weight * a * a;
  const double wbb = weight * b * b;
  const double war = weight * a * residual.x();
  const double wbr = weight * b * residual.y();
  CameraFrameTerm term;
  term.information << waa, 0, -waa * x,  //
      0, wbb, -wbb * y,                  //
      -waa * x, -wbb * y, waa * x * x + wbb * y * y + weight * c * c;
  term.gradient << war, wbr, -war * x - wbr * y - weight * c * residual.z();
  return term;
}

/// hat(p) * m: the cross product of p with each column of m.
// Forced inline, since GCC does not inline it in unity builds, which costs 1 % of SLAM.
[[gnu::always_inline]] inline Eigen::Matrix3d cross_columns(const Eigen::Vector3d& p,
                                                            const Eigen::Matrix3d& m) {
  Eigen::Matrix3d result;
  result.row(0) = p.y() * m.row(2) - p.z() * m.row(1);
  result.row(1) = p.z() * m.row(0) - p.x() * m.row(2);
  result.row(2) = p.x() * m.row(1) - p.y() * m.row(0);
  return result;
}

/// Huber loss of a squared whitened residual, quadratic up to the gate (also squared): rho(s) = s,
/// or 2 sqrt(s gate) - gate beyond.
inline double huber_loss(double chi2, double gate) {
  return chi2 <= gate ? chi2 : 2.0 * std::sqrt(chi2 * gate) - gate;
}
/// Its derivative with respect to chi2: the weight of the residual in iteratively reweighted least
/// squares.
inline double huber_weight(double chi2, double gate) {
  return chi2 <= gate ? 1.0 : std::sqrt(gate / chi2);
}

/// Squared residual charged for a point that a trial step has moved behind its camera: as expensive
/// as a miss by 1000 standard deviations, so that no step gains by hiding a point.
inline constexpr double kBehindChi2 = 1e6;

}  // namespace mh
