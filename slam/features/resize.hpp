// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

namespace mh {

/// An 8-bit image made smaller by linear interpolation between pixel centers, weights in 1/256: the
/// same bits as cv::resize with cv::INTER_LINEAR_EXACT, which cv::ORB builds its pyramid with, in a
/// third of the time. Steps of more than 1.8 px, or images of less than 16 columns, are left to it.
/// @param to  allocated, of the size wanted; may be a window of a larger image.
void resize_exactly(const cv::Mat& from, cv::Mat& to);

}  // namespace mh
