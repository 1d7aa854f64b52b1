// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "slam/core/rgbd_frame.hpp"
#include "slam/features/features.hpp"

namespace mh {

/// One level of the image pyramid.
struct PyramidLevel {
  cv::Mat image;    ///< 8-bit gray
  cv::Mat blurred;  ///< `image` under a 7x7 Gaussian of sigma 2 px: input of descriptors
  double scale_x = 1, scale_y = 1;  ///< pixels of the full image per pixel of this level

  /// Maps a pixel of this level to the full image (pixel centers at integers). Differs from
  /// cv::ORB, which multiplies by the scale alone and so is off by (scale - 1) / 2 px.
  cv::Point2d to_full(cv::Point2d p) const {
    return {(p.x + 0.5) * scale_x - 0.5, (p.y + 0.5) * scale_y - 0.5};
  }
};

/// Builds the gray pyramid: level l of size round(size / scale^l), each made from the previous one,
/// as in cv::ORB. Levels too small to be useful (below `min_size_px` in either direction) are
/// omitted.
std::vector<PyramidLevel> make_pyramid(const Grid2d<Rgb8>& color, const FeatureConfig& config,
                                       int min_size_px);

}  // namespace mh
