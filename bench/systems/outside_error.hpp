// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/core/error.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// An outside program failed its run: the message names the program, its command and what it did. A
/// MachineError, so that a crash of an outside program never looks like a regression.
struct OutsideError : MachineError {
  using MachineError::MachineError;
};

/// A coordinate beyond this in an outside program's pose is garbage: no tour goes that far, and
/// sums of squared errors stay finite.
inline constexpr double kFarthest_m = 1e6;

/// Whether a coordinate exceeds kFarthest_m.
inline bool is_too_far(const TimedPose& pose) {
  return !(pose.world_from_camera.translation().cwiseAbs().maxCoeff() <= kFarthest_m);
}

}  // namespace mh
