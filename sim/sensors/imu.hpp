// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/sensors/config.hpp"
#include "slam/core/imu.hpp"
#include "slam/core/random.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// What an inertial sensor in the camera's housing delivers along a path. Between the path's poses
/// the position follows a natural cubic spline (its acceleration is continuous) and the rotation a
/// cubic through the rotations with continuous angular rate, so that readings and poses agree. A
/// reading is the mean over its period, centered on its stamp, plus a bias (a random walk) and
/// white noise. The world's z is up; gravity is 9.81 m/s^2.
/// @returns readings from the first pose to the last; none for fewer than three poses
ImuPath imu_along(const Trajectory& world_from_camera, const ImuConfig& config, RandomStream noise);

}  // namespace mh
