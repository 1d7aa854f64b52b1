// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>

#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// The readings after one moment and up to another, of readings in order of stamps.
std::span<const ImuReading> imu_between(std::span<const ImuReading> readings, Stamp after_ns,
                                        Stamp to_ns);

}  // namespace mh
