// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "slam/core/camera.hpp"
#include "slam/core/se3.hpp"
#include "slam/features/features.hpp"

namespace mh {

/// Corrects keypoints for a rolling shutter, to the time of the middle row: each keypoint moves to
/// where its point would have been seen at that time, given rigid motion of constant velocity.
/// Keypoints without depth are moved by the rotation alone. Depth is assumed to be read together
/// with its row. Rows are counted in the undistorted image; lens distortion shifts them, but only
/// by a small share of the readout.
/// @param velocity_per_s  twist of the camera: camera_from_world(t) = exp(t v) camera_from_world(0)
/// @param readout_s       from the first row to the last; 0 changes nothing
void straighten(std::span<Keypoint> keypoints, const Camera& camera, const Vector6d& velocity_per_s,
                double readout_s);

}  // namespace mh
