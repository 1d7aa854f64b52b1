// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/core/camera.hpp"
#include "slam/core/grid2d.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// A depth camera mounted beside the color camera.
struct DepthCamera {
  Camera camera;
  SE3 color_from_depth;
};

/// Registers a depth image to the color camera: the point of each depth pixel is stored, with its
/// depth in the color camera, in the color pixel nearest to its projection; if several points fall
/// on one color pixel, the closest one is kept. If the color camera's pixels are finer, a point is
/// stored in all color pixels that its depth pixel covers. Pixels without a point have depth 0.
/// @param depth_m  along z of the depth camera; 0: not measured
Grid2d<float> registered_depth(const Grid2d<float>& depth_m, const DepthCamera& depth,
                               const Camera& color);

}  // namespace mh
