// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/core/error.hpp"
#include "slam/core/trajectory.hpp"
#include "slam/core/trajectory_io.hpp"

namespace mh {

/// An outside program failed its run: the message names the program, its command and what it did. A
/// MachineError, so that a crash of an outside program never looks like a regression.
struct OutsideError : MachineError {
  using MachineError::MachineError;
};

/// Whether a coordinate of an outside program's pose exceeds kFarthestPose_m: garbage, and sums of
/// squared errors would not stay finite.
inline bool is_too_far(const TimedPose& pose) {
  return !(pose.world_from_camera.translation().cwiseAbs().maxCoeff() <= kFarthestPose_m);
}

}  // namespace mh
