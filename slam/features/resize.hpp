// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

namespace mh {

/// Shrinks an 8-bit image by linear interpolation between pixel centers, weights in 1/256:
/// bit-identical to cv::resize with cv::INTER_LINEAR_EXACT, which cv::ORB uses for its pyramid, in
/// a third of the time. Steps of more than 1.8 px and images of fewer than 16 columns fall back to
/// cv::resize.
/// @param to  allocated, of the target size; may be a window of a larger image.
void resize_exactly(const cv::Mat& from, cv::Mat& to);

}  // namespace mh
