// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/imu.hpp"

#include <algorithm>
#include <cmath>

namespace mh {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kGravity_m_per_s2 = 9.81, kNanosecond_s = 1e-9;

/// A path in continuous time; seconds count from its first pose.
class SmoothPath {
 public:
  explicit SmoothPath(const Trajectory& path) : path_(path) {
    for (const TimedPose& pose : path)
      times_s_.push_back(static_cast<double>(pose.stamp_ns - path.front().stamp_ns) *
                         kNanosecond_s);
    find_accelerations();
    for (std::size_t i = 0; i < path.size(); ++i) {
      const std::size_t before = i == 0 ? 0 : i - 1, after = std::min(i + 1, path.size() - 1);
      turns_rad_per_s_.push_back((turn_rad(before, i) + turn_rad(i, after)) /
                                 (times_s_[after] - times_s_[before]));
    }
  }
  double duration_s() const { return times_s_.back(); }

  Vector3d velocity(double t_s) const {
    const auto [i, h, u] = at(t_s);
    const Vector3d rise = (place(i + 1) - place(i)) / h;
    return rise + h / 6 *
                      ((1 - 3 * (1 - u) * (1 - u)) * accelerations_[i] +
                       (3 * u * u - 1) * accelerations_[i + 1]);
  }
  Matrix3d rotation(double t_s) const {
    const auto [i, h, u] = at(t_s);
    const Vector3d whole = turn_rad(i, i + 1);
    // A cubic Hermite curve in the tangent space at pose i. There, the rate at the other end
    // appears rotated by half of the rotation between the poses.
    const Vector3d start = h * turns_rad_per_s_[i];
    const Vector3d end = h * (turns_rad_per_s_[i + 1] + whole.cross(turns_rad_per_s_[i + 1]) / 2);
    const double u2 = u * u, u3 = u2 * u;
    return path_[i].world_from_camera.rotation() *
           so3_exp((3 * u2 - 2 * u3) * whole + (u3 - 2 * u2 + u) * start + (u3 - u2) * end);
  }

 private:
  struct Place {
    std::size_t segment;
    double length_s, share;
  };
  Place at(double t_s) const {
    const auto after = std::ranges::upper_bound(times_s_, t_s);
    const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
        after - times_s_.begin() - 1, 0, static_cast<std::ptrdiff_t>(times_s_.size()) - 2));
    const double length_s = times_s_[i + 1] - times_s_[i];
    return {i, length_s, (t_s - times_s_[i]) / length_s};
  }
  Vector3d place(std::size_t i) const { return path_[i].world_from_camera.translation(); }
  Vector3d turn_rad(std::size_t a, std::size_t b) const {
    return so3_log(path_[a].world_from_camera.rotation().transpose() *
                   path_[b].world_from_camera.rotation());
  }

  /// Accelerations of a natural cubic spline: a tridiagonal system, solved forward and then back.
  void find_accelerations() {
    const std::size_t n = times_s_.size();
    accelerations_.assign(n, Vector3d::Zero());
    std::vector<double> upper(n, 0.0);
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const double before_s = times_s_[i] - times_s_[i - 1];
      const double after_s = times_s_[i + 1] - times_s_[i];
      const Vector3d bend =
          6 * ((place(i + 1) - place(i)) / after_s - (place(i) - place(i - 1)) / before_s);
      const double pivot = 2 * (before_s + after_s) - before_s * upper[i - 1];
      upper[i] = after_s / pivot;
      accelerations_[i] = (bend - before_s * accelerations_[i - 1]) / pivot;
    }
    for (std::size_t i = n - 1; i-- > 1;) accelerations_[i] -= upper[i] * accelerations_[i + 1];
  }

  const Trajectory& path_;
  std::vector<double> times_s_;
  std::vector<Vector3d> accelerations_;    // world frame
  std::vector<Vector3d> turns_rad_per_s_;  // camera frame
};

Vector3d normals(RandomStream stream, std::uint64_t first) {
  return {stream.normal(first), stream.normal(first + 1), stream.normal(first + 2)};
}

}  // namespace

ImuPath imu_along(const Trajectory& world_from_camera, const ImuConfig& config,
                  RandomStream noise) {
  ImuPath made;
  if (world_from_camera.size() < 3) return made;
  const SmoothPath path(world_from_camera);
  for (const TimedPose& pose : world_from_camera)
    made.velocities_m_per_s.push_back(path.velocity(
        static_cast<double>(pose.stamp_ns - world_from_camera.front().stamp_ns) * kNanosecond_s));
  const double period_s = 1 / config.rate_hz, root_s = std::sqrt(period_s);
  Vector3d gyro_bias = config.gyro_bias * normals(noise, 0);
  Vector3d accel_bias = config.accel_bias * normals(noise, 3);
  const auto count = static_cast<std::uint64_t>(path.duration_s() * config.rate_hz);
  for (std::uint64_t k = 0; k <= count; ++k) {
    const double t_s = static_cast<double>(k) * period_s;
    const double from_s = std::max(0.0, t_s - period_s / 2);
    const double to_s = std::min(path.duration_s(), t_s + period_s / 2);
    const Vector3d turn =
        so3_log(path.rotation(from_s).transpose() * path.rotation(to_s)) / (to_s - from_s);
    const Vector3d force = path.rotation(0.5 * (from_s + to_s)).transpose() *
                           ((path.velocity(to_s) - path.velocity(from_s)) / (to_s - from_s) +
                            Vector3d(0, 0, kGravity_m_per_s2));
    const RandomStream draw = noise.fork(k);
    const Stamp stamp_ns =
        world_from_camera.front().stamp_ns + static_cast<Stamp>(std::llround(t_s / kNanosecond_s));
    made.biases.push_back({stamp_ns, gyro_bias, accel_bias});
    made.readings.push_back({stamp_ns,
                             turn + gyro_bias + config.gyro_noise / root_s * normals(draw, 0),
                             force + accel_bias + config.accel_noise / root_s * normals(draw, 3)});
    gyro_bias += config.gyro_walk * root_s * normals(draw, 6);
    accel_bias += config.accel_walk * root_s * normals(draw, 9);
  }
  return made;
}

}  // namespace mh
