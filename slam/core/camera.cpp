// SPDX-License-Identifier: Apache-2.0
#include "slam/core/camera.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <Eigen/LU>

#include "slam/io/error.hpp"

namespace mh {
namespace {

/// The Jacobian of a distortion at unit depth.
Eigen::Matrix2d jacobian_of(const Distortion& d, const Eigen::Vector2d& p) {
  const double x = p.x(), y = p.y(), r2 = x * x + y * y, radial = d.radial(r2);
  const double below = 1.0 + r2 * (d.k4 + r2 * (d.k5 + r2 * d.k6));
  // Twice the derivatives of the numerator and the denominator with respect to r^2, then that of
  // their quotient.
  const double above_slope = 2.0 * (d.k1 + r2 * (2.0 * d.k2 + 3.0 * r2 * d.k3)),
               below_slope = 2.0 * (d.k4 + r2 * (2.0 * d.k5 + 3.0 * r2 * d.k6));
  const double slope = (above_slope - radial * below_slope) / below;
  Eigen::Matrix2d jacobian;
  jacobian << radial + x * x * slope + 2.0 * d.p1 * y + 6.0 * d.p2 * x,
      x * y * slope + 2.0 * d.p1 * x + 2.0 * d.p2 * y,
      x * y * slope + 2.0 * d.p1 * x + 2.0 * d.p2 * y,
      radial + y * y * slope + 6.0 * d.p1 * y + 2.0 * d.p2 * x;
  return jacobian;
}

}  // namespace

void validate(const Camera& camera) {
  const auto require = [](bool good, const char* field, double value) {
    if (!good || !std::isfinite(value))
      throw InputError(fmt::format("camera: {} = {} is out of range", field, value));
  };
  require(camera.width_px > 0, "width_px", camera.width_px);
  require(camera.height_px > 0, "height_px", camera.height_px);
  // Whether a focal length gives a field of view below 174 degrees and above three arc minutes.
  const auto is_focal = [&](double f) {
    return f > 0.05 * camera.width_px / 2 && f < 1e3 * camera.width_px;
  };
  require(is_focal(camera.fx_px), "fx_px", camera.fx_px);
  require(is_focal(camera.fy_px), "fy_px", camera.fy_px);
  require(camera.cx_px >= 0 && camera.cx_px <= camera.width_px - 1, "cx_px", camera.cx_px);
  require(camera.cy_px >= 0 && camera.cy_px <= camera.height_px - 1, "cy_px", camera.cy_px);
  require(camera.rate_hz > 0, "rate_hz", camera.rate_hz);
  require(camera.baseline_m > 0, "baseline_m", camera.baseline_m);
  require(camera.disparity_sigma_px > 0, "disparity_sigma_px", camera.disparity_sigma_px);
}

Eigen::Vector2d Distortion::undistorted(double x, double y) const {
  const Eigen::Vector2d wanted(x, y);
  Eigen::Vector2d p = wanted;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector2d error = distorted(p.x(), p.y()) - wanted;
    if (error.norm() < 1e-10) return p;
    p -= jacobian_of(*this, p).inverse() * error;
  }
  return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
}

std::string text_of(const Distortion& distortion, const char* is) {
  constexpr std::array kNames = {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
  std::string text;
  const std::vector<double> values = coefficients_of(distortion);
  for (std::size_t i = 0; i < values.size(); ++i)
    text += fmt::format("{}{}{}{}", i == 0 ? "" : ", ", kNames[i], is, values[i]);
  return text;
}

Distortion distortion_of(std::vector<double> k) {
  k.resize(8, 0.0);
  return {k[0], k[1], k[2], k[3], k[4], k[5], k[6], k[7]};
}

std::vector<double> coefficients_of(const Distortion& d) {
  if (d.is_rational()) return {d.k1, d.k2, d.p1, d.p2, d.k3, d.k4, d.k5, d.k6};
  return {d.k1, d.k2, d.p1, d.p2, d.k3};
}

Camera resized(Camera camera, int width_px, int height_px) {
  camera.fx_px *= static_cast<double>(width_px) / camera.width_px;
  camera.cx_px = (camera.cx_px + 0.5) * width_px / camera.width_px - 0.5;
  camera.fy_px *= static_cast<double>(height_px) / camera.height_px;
  camera.cy_px = (camera.cy_px + 0.5) * height_px / camera.height_px - 0.5;
  camera.width_px = width_px, camera.height_px = height_px;
  return camera;
}

}  // namespace mh
