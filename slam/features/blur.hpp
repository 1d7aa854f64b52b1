// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

namespace mh {

/// Pixels around an image that blur_7x7() reads.
inline constexpr int kBlurRadius_px = 3;

/// An 8-bit image with a margin of kBlurRadius_px around it, and room to read whole registers.
cv::Mat image_to_blur(cv::Size size);

/// Blurs by a 7x7 Gaussian of sigma 2 px: the bits of cv::GaussianBlur on a window of a larger
/// image, which cv::ORB's descriptors are computed from, in half the time.
/// @param image  made by image_to_blur(), its margin filled
cv::Mat blur_7x7(const cv::Mat& image);

}  // namespace mh
