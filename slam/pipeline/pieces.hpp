// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "slam/pipeline/slam.hpp"

namespace mh {

/// Where a new piece of the map begins with a frame: the pose that the camera has if it moved on as
/// before it was lost. Nothing before TrackConfig::new_piece_after_s, or if the frame was located
/// when it was shown before.
std::optional<SE3> place_of_new_piece(const SlamState& state, Stamp stamp_ns);

/// Whether a piece of the map can be where it seems to be in another. The camera is known to have
/// gone from there to here, exactly within the pieces that it passed; between them, while it saw
/// nothing, it moved on about as before, at TrackConfig::max_speed_m_s at most (0: anything is
/// possible).
/// @param other  the other piece and, in the place of a camera, other_from_own
bool is_reachable(const SlamState& state, KeyframeId origin, const MapPose& other);

}  // namespace mh
