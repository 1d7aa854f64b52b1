// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/replay.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sim/motion/floor_grid.hpp"
#include "slam/core/path_length.hpp"
#include "slam/core/random.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kPlacings = 20000;

Trajectory at_rate(const Trajectory& recorded, double rate_hz) {
  Trajectory result;
  const Stamp first = recorded.front().stamp_ns, last = recorded.back().stamp_ns;
  std::size_t k = 0;
  for (std::int64_t i = 0;; ++i) {
    const Stamp stamp = std::llround(static_cast<double>(i) * 1e9 / rate_hz);
    if (first + stamp > last) return result;
    while (k + 2 < recorded.size() && recorded[k + 1].stamp_ns <= first + stamp) ++k;
    const TimedPose &a = recorded[k], &b = recorded[k + 1];
    const double share = static_cast<double>(first + stamp - a.stamp_ns) /
                         static_cast<double>(b.stamp_ns - a.stamp_ns);
    const Vector6d twist = (a.world_from_camera.inverse() * b.world_from_camera).log();
    result.push_back({stamp, (a.world_from_camera * SE3::exp(share * twist)).normalized()});
  }
}

/// Returns world_from_recording, which puts the first camera at (at.x, at.y) and rotates everything
/// by at.z about the vertical axis through it.
SE3 placing(const Vector3d& first_m, const Vector3d& at) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(at.z(), Vector3d::UnitZ()).toRotationMatrix();
  const Vector3d pivot(first_m.x(), first_m.y(), 0);
  return {turn, Vector3d(at.x(), at.y(), 0) - turn * pivot};
}

bool keeps_clear(const FloorGrid& grid, const Trajectory& path, const SE3& world_from_recording,
                 double room_m) {
  return std::ranges::all_of(path, [&](const TimedPose& pose) {
    const Vector3d p = world_from_recording * pose.world_from_camera.translation();
    return grid.clearance_at(p.head<2>()) >= room_m;
  });
}

}  // namespace

DrivenPath replay(const Scene& scene, const Camera& camera, const Trajectory& recorded,
                  const std::string& name, const ReplayConfig& config) {
  if (recorded.size() < 2)
    throw InputError(fmt::format("{}: has fewer than two poses to replay", name));
  constexpr double kLongest_s = 24 * 3600;
  const double lasts_s =
      static_cast<double>(recorded.back().stamp_ns - recorded.front().stamp_ns) * 1e-9;
  if (lasts_s > kLongest_s)
    throw InputError(
        fmt::format("{}: lasts {:.0f} s, a replay at most {:.0f}", name, lasts_s, kLongest_s));
  const Trajectory path = at_rate(recorded, camera.rate_hz);
  double low_m = 1e9, high_m = -1e9;
  for (const TimedPose& pose : path) {
    low_m = std::min(low_m, pose.world_from_camera.translation().z());
    high_m = std::max(high_m, pose.world_from_camera.translation().z());
  }
  // The camera can only touch what extends into the heights that it passes through.
  const FloorGrid grid =
      make_floor_grid(scene, {.bottom_m = low_m - config.room_m, .top_m = high_m + config.room_m});
  const Vector3d first_m = path.front().world_from_camera.translation();

  std::optional<SE3> world_from_recording;
  if (config.at) {
    world_from_recording = placing(first_m, *config.at);
    if (!keeps_clear(grid, path, *world_from_recording, config.room_m))
      throw InputError(fmt::format(
          "{}: started at [{:.2f}, {:.2f}] and turned by {:.0f} deg, it would run into something",
          name, config.at->x(), config.at->y(), config.at->z() * 180 / M_PI));
  }
  const RandomStream draw = RandomStream(config.seed).fork(0x7265706c);
  for (std::uint64_t i = 0; i < kPlacings && !world_from_recording; ++i) {
    const Vector2d share(draw.uniform(3 * i), draw.uniform(3 * i + 1));
    const Vector2d size(grid.clearance_m.width(), grid.clearance_m.height());
    const Vector2d place = grid.origin_m + grid.resolution_m * share.cwiseProduct(size);
    const SE3 tried =
        placing(first_m, {place.x(), place.y(), draw.uniform(3 * i + 2, -M_PI, M_PI)});
    if (keeps_clear(grid, path, tried, config.room_m)) world_from_recording = tried;
  }
  if (!world_from_recording)
    throw InputError(
        fmt::format("{}: fits nowhere in {}: {} placements were tried, and each passes within "
                    "{:.2f} m of something",
                    name, scene.name, kPlacings, config.room_m));

  DrivenPath driven;
  const Eigen::Matrix3d turn = world_from_recording->rotation();
  const Vector3d shift_m = world_from_recording->translation();
  driven.moved = fmt::format(
      "{}: its poses are moved to where the camera touches nothing: turned by {:.1f} deg about the "
      "vertical, then shifted by [{:.3f}, {:.3f}] m, and sampled at {:g} Hz",
      name, std::atan2(turn(1, 0), turn(0, 0)) * 180 / M_PI, shift_m.x(), shift_m.y(),
      camera.rate_hz);
  for (const TimedPose& pose : path) {
    const SE3 world_from_camera = *world_from_recording * pose.world_from_camera;
    const Vector3d ahead = world_from_camera.rotation().col(2), p = world_from_camera.translation();
    const Eigen::Matrix3d heading =
        Eigen::AngleAxisd(std::atan2(ahead.y(), ahead.x()), Vector3d::UnitZ()).toRotationMatrix();
    driven.camera.push_back({pose.stamp_ns, world_from_camera});
    driven.base.push_back({pose.stamp_ns, SE3(heading, {p.x(), p.y(), 0.0})});
    if (driven.base.size() > 1)
      driven.length_m +=
          (p.head<2>() -
           driven.base[driven.base.size() - 2].world_from_camera.translation().head<2>())
              .norm();
  }
  return driven;
}

DrivenPath as_given(const Trajectory& poses, PosesOf of, const SE3& base_from_camera) {
  DrivenPath path;
  for (const TimedPose& given : poses) {
    const SE3& pose = given.world_from_camera;
    const bool of_camera = of == PosesOf::kCamera;
    path.camera.push_back({given.stamp_ns, of_camera ? pose : pose * base_from_camera});
    path.base.push_back({given.stamp_ns, of_camera ? pose * base_from_camera.inverse() : pose});
  }
  path.length_m = path_length_m(path.camera);
  return path;
}

}  // namespace mh
