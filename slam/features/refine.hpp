// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

namespace mh {

/// The corner near a pixel to a fraction of it: the point that lies closest to the lines through
/// all pixels of a small window along their edges, weighted by gradient (Foerstner and Guelch, 1987).
/// FAST knows whole pixels of its level only, up to 3.6 px of the picture on the coarsest.
/// @returns the corner in the image's coordinates; the pixel itself where the window holds no corner
/// or the corner lies more than one pixel away.
cv::Point2d refine_corner(const cv::Mat& image, int x, int y);

}  // namespace mh
