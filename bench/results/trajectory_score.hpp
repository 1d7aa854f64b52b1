// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/results/run_result.hpp"

namespace mh {

/// ATE, RPE and completeness of an estimate, by the definitions of bench/metrics.
/// @param truth    every frame of the sequence
/// @param offered  frames that the system was to map
TrajectoryScore score_trajectory(const Trajectory& estimate, const Trajectory& truth,
                                 std::size_t offered);

}  // namespace mh
