// SPDX-License-Identifier: Apache-2.0
#include "slam/track/tracker.hpp"

#include <cmath>
#include <utility>

namespace mh {

double seconds_since_last(const Tracker& tracker, Stamp stamp_ns) {
  constexpr double kSecond_ns = 1e9;
  return static_cast<double>(stamp_ns - tracker.last->stamp_ns) / kSecond_ns;
}

SE3 predict(const Tracker& tracker, Stamp stamp_ns) {
  if (!tracker.velocity_per_s) return tracker.last->camera_from_world;
  const double elapsed_s = seconds_since_last(tracker, stamp_ns);
  return SE3::exp(*tracker.velocity_per_s * elapsed_s) * tracker.last->camera_from_world;
}

std::optional<SE3> odometry_step(const Tracker& tracker,
                                 const std::optional<SE3>& odom_from_camera) {
  const std::optional<SE3>& before = tracker.last->odom_from_camera;
  if (!before || !odom_from_camera) return std::nullopt;
  return odom_from_camera->inverse() * *before;
}

void update_velocity(Tracker& tracker, Stamp stamp_ns, const SE3& camera_from_world) {
  tracker.velocity_per_s.reset();
  if (!tracker.last || stamp_ns <= tracker.last->stamp_ns) return;
  const double elapsed_s = seconds_since_last(tracker, stamp_ns);
  tracker.velocity_per_s =
      (camera_from_world * tracker.last->camera_from_world.inverse()).log() / elapsed_s;
}

void remember(Tracker& tracker, LastFrame frame, KeyframeId reference,
              const std::optional<Motion>& motion) {
  tracker.last = std::move(frame);
  tracker.motion = motion;
  tracker.reference = reference;
  tracker.coasting = false;
}

void forget(Tracker& tracker) {
  Tracker fresh;
  fresh.inertial_known = tracker.inertial_known;
  fresh.stale_scores = std::move(tracker.stale_scores);
  tracker = std::move(fresh);
}

void lose(Tracker& tracker, Stamp stamp_ns, double coast_s) {
  tracker.inertial.reset();
  const double lost_s = tracker.last ? seconds_since_last(tracker, stamp_ns) : HUGE_VAL;
  if (lost_s >= 0 && lost_s < coast_s)
    tracker.coasting = true;
  else
    forget(tracker);
}

}  // namespace mh
