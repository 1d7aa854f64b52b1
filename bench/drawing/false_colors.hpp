// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "slam/core/grid2d.hpp"
#include "slam/core/labels.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Depth as 8-bit BGR: near is red, far is a bright blue (Turbo without its dark ends); no return
/// is a light gray, which neither the scale nor a class comes near to.
cv::Mat depth_colors(const Grid2d<float>& depth_m, float near_m, float far_m);
/// The scale of depth_colors(), 256 x 1, near to far.
cv::Mat depth_scale();

/// The color that a class has in pictures for people, the same in every picture; color-blind people
/// can tell any two that touch.
Rgb8 class_color(ClassId id);

/// How different two colors look: their distance in CIE L*a*b* (1976). About 2 can just be seen.
double color_distance(Rgb8 a, Rgb8 b);

}  // namespace mh
