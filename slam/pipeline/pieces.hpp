// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "slam/pipeline/slam.hpp"

namespace mh {

/// The camera pose with which a frame begins a new piece of the map: the one that the camera has if
/// it kept moving as it did before it was lost. nullopt before TrackConfig::new_piece_after_s has
/// passed, or if the frame was located when it was shown before.
std::optional<SE3> place_of_new_piece(const SlamState& state, Stamp stamp_ns);

/// Whether the estimated pose of one piece of the map in another is plausible, given the camera's
/// path from the other piece to this one. The path is known exactly within each piece. Between two
/// pieces, while it was lost, the camera is assumed to have kept moving about as before, no faster
/// than TrackConfig::max_speed_m_s (0: any pose is plausible).
/// @param other  origin of the other piece and, as camera_from_world, PiecePlace::other_from_own
bool is_reachable(const SlamState& state, KeyframeId origin, const MapPose& other);

}  // namespace mh
