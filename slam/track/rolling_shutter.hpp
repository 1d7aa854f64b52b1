// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "slam/core/camera.hpp"
#include "slam/core/se3.hpp"
#include "slam/features/features.hpp"

namespace mh {

/// Brings what a rolling shutter saw row by row to the moment of the middle row: each keypoint goes
/// where its point was seen then, by a rigid motion of constant velocity; one without depth by the
/// turn alone. Depth counts as read together with its row. Rows are those of the undistorted image,
/// which a lens shifts by a small share of the readout.
/// @param velocity_per_s  twist of the camera: camera_from_world(t) = exp(t v) camera_from_world(0)
/// @param readout_s       from the first row to the last; 0 changes no bit
void straighten(std::span<Keypoint> keypoints, const Camera& camera, const Vector6d& velocity_per_s,
                double readout_s);

}  // namespace mh
