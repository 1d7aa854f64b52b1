// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "slam/core/trajectory.hpp"

namespace mh {

/// Largest gap between two neighbors in time across which a pose is interpolated. Holding out
/// frames leaves gaps of one or two frames; across longer gaps, interpolation is meaningless.
inline constexpr Stamp kMaxNeighborGap_ns = 500'000'000;

/// The same for ground truth, which a recording may give at times different from those of its
/// frames. Over this gap g, a hand with an acceleration a of 5 m/s2 and 10 rad/s2 deviates from the
/// interpolation by a g^2/8: 1.6 mm and 0.2 degrees. The gap is shorter than two frames at 30 Hz,
/// so that a frame whose own pose is invalid does not get one from its neighbors.
inline constexpr Stamp kMaxTruthGap_ns = 50'000'000;

/// Returns the pose at a stamp: the one with this stamp or, if there is none, one interpolated
/// between its neighbors in time (position linearly, rotation along the shortest arc). Applied to
/// the poses of mapped frames, it gives the paper's estimate of a query camera's pose in the
/// system's own map. Returns nullopt if a neighbor is missing or the two are more than max_gap_ns
/// apart.
std::optional<SE3> interpolated_pose(const Trajectory& trajectory, Stamp stamp_ns,
                                     Stamp max_gap_ns = kMaxNeighborGap_ns);

}  // namespace mh
