// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/core/error.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// An outside program failed its run: the message names the program, its command and what it did.
/// A MachineError, so that a crash of somebody's program never looks like a regression.
struct OutsideError : MachineError {
  using MachineError::MachineError;
};

/// A pose of an outside program with a coordinate beyond this is garbage: no tour goes that far,
/// and what errors are summed up of its square stays a number.
inline constexpr double kFarthest_m = 1e6;

/// Whether a coordinate lies beyond kFarthest_m.
inline bool is_too_far(const TimedPose& pose) {
  return !(pose.world_from_camera.translation().cwiseAbs().maxCoeff() <= kFarthest_m);
}

}  // namespace mh
