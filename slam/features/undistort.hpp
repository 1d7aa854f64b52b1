// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "slam/core/camera.hpp"

namespace mh {

/// Maps pixels to where a camera without distortion would show them, accurate to 1/1000 px for
/// cameras that pass require_undistortable().
void undistort(const Camera& camera, std::vector<Eigen::Vector2d>& points_px);

/// @throws InputError naming coefficients and pixel if the camera's distortion cannot be inverted
/// over the whole image: where it folds the image, or is so strong that the search for the ray does
/// not converge.
void require_undistortable(const Camera& camera);

}  // namespace mh
