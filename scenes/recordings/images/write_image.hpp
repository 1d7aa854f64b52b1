// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <type_traits>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Converts an image to 8-bit BGR.
cv::Mat color_image(const Grid2d<Rgb8>& color);

/// A view of a grid of 8- or 16-bit numbers as a gray image in the same memory: read-only, and
/// valid as long as the grid.
template <class Number>
cv::Mat gray_image(const Grid2d<Number>& grid) {
  static_assert(std::is_unsigned_v<Number> && sizeof(Number) <= 2);
  return {grid.height(), grid.width(), sizeof(Number) == 1 ? CV_8UC1 : CV_16UC1,
          const_cast<Number*>(grid.data())};
}

/// Writes an image atomically, in the format given by the file's extension.
/// @param settings  the format's settings, as for cv::imencode
/// @throws InputError if it cannot be written.
void write_image(const std::filesystem::path& file, const cv::Mat& bgr,
                 const std::vector<int>& settings = {});

}  // namespace mh
