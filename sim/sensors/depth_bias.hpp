// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/sensors/sense.hpp"

namespace mh {

/// A depth image (m, 0 = no return) as a camera with systematic errors reports it. First each pixel
/// takes the depth of the pixel nearest to shift_x_px, shift_y_px from it; what lies outside gives
/// no return. Then z becomes z * scale * (1 + bend * f), where f varies smoothly over the image and
/// with distance: with x and y from 0 to 1 over the image and s = 1 - 2 z0 / (z + z0), z0 = 1.5 m,
///   f = sum over i, j = 0..2 of (a_ij + s b_ij) cos(i pi x) cos(j pi y),
/// a_00 = 0. The other coefficients are normal numbers drawn for the camera, scaled so that the
/// mean of f^2 over the image and over s = -1 and s = 1 is 1.
Grid2d<float> biased_depth(const Grid2d<float>& depth_m, const DepthBiasConfig& config);

}  // namespace mh
