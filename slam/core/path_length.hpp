// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "slam/core/trajectory.hpp"

namespace mh {

/// Length (m) of the polyline through the positions.
double path_length_m(const Trajectory& trajectory);

/// Length (m) of the segment that ends at pose i. @pre i > 0
double step_length_m(const Trajectory& trajectory, std::size_t i);

}  // namespace mh
