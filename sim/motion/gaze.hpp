// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "scenes/scene.hpp"
#include "sim/motion/feet.hpp"
#include "sim/motion/handheld_scan.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/random.hpp"

namespace mh::handheld {

/// Where the camera looks in each frame.
struct Looks {
  std::vector<double> yaw_rad, pitch_rad;
};
/// Simulates the gaze of a person who scans a room, turn after turn.
Looks looks_along(const Scene& scene, const std::vector<Eigen::Vector2d>& feet_m,
                  const Ground& ground, const Camera& camera, const HandheldConfig& config,
                  RandomStream stream);

}  // namespace mh::handheld
