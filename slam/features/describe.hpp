// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

#include "slam/features/features.hpp"

namespace mh {

/// Orientation of the patch around a pixel: direction from the pixel to the intensity centroid of a
/// disk of radius 15 px (Rosin 1999; Rublee et al., ICCV 2011, section 3.2), degrees in [0, 360).
/// @pre the pixel is at least kPatchReach_px from the border.
float orientation_deg(const cv::Mat& image, int x, int y);

/// Rotated BRIEF at a pixel (Rublee et al., section 4), with the arithmetic of cv::ORB: the same
/// bits for the same angle. @param blurred  PyramidLevel::blurred.
Descriptor describe(const cv::Mat& blurred, int x, int y, float angle_rad);

/// Converts to radians as cv::ORB does, in single precision.
inline float to_radians(float angle_deg) {
  return angle_deg * static_cast<float>(CV_PI / 180.0);
}

}  // namespace mh
