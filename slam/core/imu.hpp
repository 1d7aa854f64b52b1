// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Readings of an inertial sensor along a path, with ground truth.
struct ImuPath {
  std::vector<ImuReading> readings;
  std::vector<ImuReading> biases;                   ///< of each reading: its slowly varying error
  std::vector<Eigen::Vector3d> velocities_m_per_s;  ///< at each pose of the path, in the world
};

/// The readings later than one stamp and no later than another. @pre `readings` are in order of
/// stamps
std::span<const ImuReading> imu_between(std::span<const ImuReading> readings, Stamp after_ns,
                                        Stamp to_ns);

}  // namespace mh
