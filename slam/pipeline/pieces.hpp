// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "slam/pipeline/slam.hpp"

namespace mh {

/// The camera pose with which a frame begins a new piece of the map. It is the pose that the camera
/// has if it kept moving as before it was lost. nullopt before TrackConfig::new_piece_after_s has
/// passed, or if the frame was located when it was shown before.
std::optional<SE3> place_of_new_piece(const SlamState& state, Stamp stamp_ns);

/// Whether a piece of the map can be where it seems to be in another. The camera's path from there
/// to here is known exactly within the pieces that it passed through; between them, while it saw
/// nothing, the camera is assumed to have kept moving about as before, no faster than
/// TrackConfig::max_speed_m_s (0: anything is possible).
/// @param other  the other piece and, in place of a camera pose, other_from_own
bool is_reachable(const SlamState& state, KeyframeId origin, const MapPose& other);

}  // namespace mh
