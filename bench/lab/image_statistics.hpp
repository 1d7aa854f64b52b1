// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "slam/core/grid2d.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Measures of how hard an image is for feature extraction (texture, blankness, sharpness), in the
/// order of kImageQuantities.
inline constexpr std::size_t kImageQuantityCount = 8;
using ImageStatistics = std::array<double, kImageQuantityCount>;

struct ImageQuantity {
  std::string_view key, name;
};
inline constexpr std::array<ImageQuantity, kImageQuantityCount> kImageQuantities = {{
    {"fast_20", "FAST corners, threshold 20"},
    {"fast_7", "FAST corners, threshold 7"},
    {"orb", "ORB keypoints, at most 2000"},
    {"gradient_median", "gradient, median (gray levels/px)"},
    {"gradient_p95", "gradient, 95th percentile"},
    {"blank_cells", "share of blank 40x30 cells"},
    {"spectrum_slope", "slope of the power spectrum"},
    {"laplacian_variance", "variance of the Laplacian"},
}};

/// Measures an image scaled to 640x480:
/// - corners by cv::FAST with non-maximum suppression; keypoints by cv::ORB (8 levels of 1.2, at
///   most 2000, threshold 20);
/// - the gradient magnitude by Sobel / 8; a cell of 40x30 pixels is blank if 95 % of its gradients
///   are below 3;
/// - the slope of log power over log frequency from 8 to 159 cycles, averaged over rings, of the
///   middle 480x480 under a Hann window;
/// - the variance of the 4-neighbor Laplacian.
/// @param gray 8 bits, one channel, not empty
ImageStatistics measure_image(const cv::Mat& gray);
ImageStatistics measure_image(const Grid2d<Rgb8>& color);

/// A quantity as text for tables: three digits, or an integer from 1000 on.
std::string shown(double quantity);

/// The value below which the given share of a list falls, interpolated between neighbors; NaN if
/// the list is empty.
double percentile(std::vector<double> values, double share);

}  // namespace mh
