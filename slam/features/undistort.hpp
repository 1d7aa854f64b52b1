// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "slam/core/camera.hpp"

namespace mh {

/// Pixels as a camera without distortion would show them, good to 1/1000 px wherever
/// require_undistortable() is content.
void undistort(const Camera& camera, std::vector<Eigen::Vector2d>& points_px);

/// @throws InputError naming coefficients and pixel if the camera's distortion cannot be undone all
/// over its picture: where it folds the picture, or is so strong that the search for the ray ends
/// nowhere.
void require_undistortable(const Camera& camera);

}  // namespace mh
