// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// What an inertial sensor delivers along a path, with its truth.
struct ImuPath {
  std::vector<ImuReading> readings;
  std::vector<ImuReading> biases;                   ///< of each reading: what it errs by, for long
  std::vector<Eigen::Vector3d> velocities_m_per_s;  ///< at each pose of the path, in the world
};

/// The readings after one moment and up to another, of readings in order of stamps.
std::span<const ImuReading> imu_between(std::span<const ImuReading> readings, Stamp after_ns,
                                        Stamp to_ns);

}  // namespace mh
