// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/pipeline/prepared_frame.hpp"
#include "slam/track/track.hpp"

namespace mh {

/// Turns a frame into a keyframe: maps it, then looks for a loop and closes it, or joins its piece
/// of the map to another. The frame keeps its features.
/// @param origin  Keyframe::origin
KeyframeId add_keyframe(SlamState& state, PreparedFrame& frame, const TrackedPose& tracked,
                        KeyframeId origin, RandomStream stream, const StepObservers& observers,
                        StepReport& report);

}  // namespace mh
