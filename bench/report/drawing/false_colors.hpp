// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "slam/core/grid2d.hpp"
#include "slam/core/labels.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Depth as 8-bit BGR: near is red and far is bright blue (Turbo without its dark ends). Pixels
/// without a return are light gray, which differs from every color of the scale and of the classes.
cv::Mat depth_colors(const Grid2d<float>& depth_m, float near_m, float far_m);
/// The scale of depth_colors(), 256 x 1, near to far.
cv::Mat depth_scale();

/// The color of a class in images for people, the same in every image; color-blind people can tell
/// apart any two that touch.
Rgb8 class_color(ClassId id);

/// Perceptual difference of two colors: their distance in CIE L*a*b* (1976). About 2 is just
/// noticeable.
double color_distance(Rgb8 a, Rgb8 b);

}  // namespace mh
