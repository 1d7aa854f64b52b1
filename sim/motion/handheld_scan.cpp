// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/handheld_scan.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "sim/motion/feet.hpp"
#include "sim/motion/gaze.hpp"
#include "sim/motion/signal.hpp"
#include "slam/core/angles.hpp"
#include "slam/core/random.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

using namespace handheld;

enum Stream : std::uint64_t { kPlaces, kBouts, kGaze, kRoll, kHeight, kBody, kHands, kTremor };

/// Orientation of the optical frame (z forward, x right, y down) of a camera with this yaw (from
/// world x), pitched down and rolled clockwise.
Eigen::Matrix3d looking(double yaw_rad, double pitch_rad, double roll_rad) {
  Eigen::Matrix3d body_from_optical;
  body_from_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return (Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()) *
          Eigen::AngleAxisd(pitch_rad, Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll_rad, Vector3d::UnitX()))
             .toRotationMatrix() *
         body_from_optical;
}

std::size_t frames_for(double area_m2, double rate_hz) {
  const double s = std::clamp(10.0 + 1.3 * area_m2, 10.0, 50.0);  // 300 to 1,500 at 30 Hz
  return static_cast<std::size_t>(std::lround(s * rate_hz));
}

}  // namespace

void validate(const HandheldConfig& config) {
  const auto check = [](const char* field, double value, double low, double high) {
    if (!(value >= low && value <= high))
      throw InputError(
          fmt::format("handheld motion: {}: {} is outside {} to {}", field, value, low, high));
  };
  if (config.frames) check("frames", static_cast<double>(*config.frames), 30, 1e5);
  check("height_m", config.height_m, 0.3, kHead_m);
  check("walking_m_per_s", config.walking_m_per_s, 0, 2);
  check("turning_rad_per_s", config.turning_rad_per_s, 0.05, 4);
  check("fast_turn_every", config.fast_turn_every, 0, 1e6);
  check("gait", config.gait, 0, 3);
  check("sway_rms_m", config.sway_rms_m, 0, 0.05);
  check("wander_rms_rad", config.wander_rms_rad, 0, 0.2);
  check("tremor_rms_m", config.tremor_rms_m, 0, 0.01);
  check("tremor_rms_rad", config.tremor_rms_rad, 0, 0.05);
}

DrivenPath handheld_scan(const Scene& scene, const Camera& camera, const HandheldConfig& config) {
  validate(config);
  const RandomStream stream = RandomStream(config.seed).fork(0x68616e64);  // for this motion only
  const Ground ground = ground_of(scene, config.height_m);
  const std::size_t frames = config.frames.value_or(frames_for(ground.area_m2, camera.rate_hz));

  const Feet feet = feet_on(ground, config, frames, camera.rate_hz, stream.fork(kBouts),
                            stream.fork(kPlaces).key());
  const std::vector<Vector2d>& feet_m = feet.at_m;
  const std::vector<double>& speed = feet.speed_m_per_s;
  const Looks looks = looks_along(scene, feet_m, ground, camera, config, stream.fork(kGaze));

  const BandNoise height(stream.fork(kHeight), 0.03, 0.05, 0.2);
  const BandNoise roll(stream.fork(kRoll), 1.5 * kDegree, 0.05, 0.4);
  std::vector<BandNoise> sway, wander, tremor, shake;
  for (std::uint64_t axis = 0; axis < 3; ++axis) {
    sway.emplace_back(stream.fork(kBody).fork(axis), config.sway_rms_m, 0.1, 0.9);
    wander.emplace_back(stream.fork(kHands).fork(axis), config.wander_rms_rad, 0.3, 2.0);
    tremor.emplace_back(stream.fork(kTremor).fork(axis), config.tremor_rms_m, 6.0, 12.0);
    shake.emplace_back(stream.fork(kTremor).fork(3 + axis), config.tremor_rms_rad, 6.0, 12.0);
  }

  DrivenPath path;
  double stride_rad = 0;  // two steps are one stride
  for (std::size_t i = 0; i < frames; ++i) {
    const double t_s = static_cast<double>(i) / camera.rate_hz;
    // 0.7 strides/s at 0.7 m/s, proportional to the square root of the speed (Grieve and Gear,
    // 1966).
    stride_rad += 2 * M_PI * 0.7 * std::sqrt(speed[i] / 0.7) / camera.rate_hz;
    const double share = config.gait * speed[i] / 0.7;
    const Vector2d ahead = feet_m[std::min(i + 1, frames - 1)] - feet_m[i == 0 ? 0 : i - 1];
    const Vector2d way_ahead =
        ahead.norm() > 1e-9 ? Vector2d(ahead.normalized()) : Vector2d(1.0, 0.0);
    const Vector2d aside(-way_ahead.y(), way_ahead.x());
    Vector3d position(feet_m[i].x(), feet_m[i].y(), config.height_m + height.at(t_s));
    position.head<2>() += 0.5 * 0.0699 * share * std::sin(stride_rad) * aside;
    position.z() += 0.5 * 0.0274 * share * std::cos(2 * stride_rad);
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      position[axis] += (axis == 2 ? 0.3 : 1.0) * sway[k].at(t_s) + tremor[k].at(t_s);
    }
    const double yaw = looks.yaw_rad[i] + wander[0].at(t_s) + shake[0].at(t_s);
    const Eigen::Matrix3d rotation =
        looking(yaw, looks.pitch_rad[i] + wander[1].at(t_s) + shake[1].at(t_s),
                roll.at(t_s) + wander[2].at(t_s) + shake[2].at(t_s));
    const Stamp stamp_ns = std::llround(static_cast<double>(i) * 1e9 / camera.rate_hz);
    path.camera.push_back({stamp_ns, SE3(rotation, position)});
    path.base.push_back({stamp_ns, SE3(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix(),
                                       {position.x(), position.y(), 0.0})});
    if (i > 0)
      path.length_m += (path.base[i].world_from_camera.translation() -
                        path.base[i - 1].world_from_camera.translation())
                           .norm();
  }
  return path;
}

}  // namespace mh
