// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/view_noise.hpp"

#include <cmath>
#include <numbers>

namespace mh {
namespace {

constexpr std::size_t kAxes = 6;
constexpr double kCellM = 1.0;
constexpr double kCellOfDirection = 0.5;  // length in the unit direction vector: 29 degrees

double smooth(double x) {
  return x * x * (3.0 - 2.0 * x);
}

}  // namespace

ViewNoise::ViewNoise(const SE3& world_from_camera) {
  const Eigen::Vector3d& at = world_from_camera.translation();
  const Eigen::Vector3d direction = world_from_camera.rotation().col(2);
  std::array<std::int64_t, kAxes> cell;
  std::array<double, kAxes> share;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis % 3);
    const double x = axis < 3 ? at[k] / kCellM : direction[k] / kCellOfDirection;
    cell[axis] = static_cast<std::int64_t>(std::floor(x));
    share[axis] = smooth(x - std::floor(x));
  }
  double squares = 0.0;
  for (std::size_t corner = 0; corner < kCorners; ++corner) {
    corner_[corner] = 0;
    weight_[corner] = 1.0;
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const bool upper = (corner >> axis) & 1U;
      corner_[corner] =
          mix(corner_[corner] ^ static_cast<std::uint64_t>(cell[axis] + (upper ? 1 : 0)));
      weight_[corner] *= upper ? share[axis] : 1.0 - share[axis];
    }
    squares += weight_[corner] * weight_[corner];
  }
  for (double& weight : weight_) weight /= std::sqrt(squares);
}

double ViewNoise::normal(RandomStream stream) const {
  double sum = 0.0;
  for (std::size_t corner = 0; corner < kCorners; ++corner)
    if (weight_[corner] > 0.0) sum += weight_[corner] * stream.normal(corner_[corner]);
  return sum;
}

double normal_cdf(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

}  // namespace mh
