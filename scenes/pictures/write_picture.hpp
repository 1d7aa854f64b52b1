// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <type_traits>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// The same picture as 8-bit BGR.
cv::Mat color_picture(const Grid2d<Rgb8>& color);

/// A grid of numbers of 8 or 16 bits as a gray picture in the same memory: for reading, and no
/// longer than the grid is there.
template <class Number>
cv::Mat gray_picture(const Grid2d<Number>& grid) {
  static_assert(std::is_unsigned_v<Number> && sizeof(Number) <= 2);
  return {grid.height(), grid.width(), sizeof(Number) == 1 ? CV_8UC1 : CV_16UC1,
          const_cast<Number*>(grid.data())};
}

/// Writes a picture, in the format that the file's ending tells, whole or not at all.
/// @param settings  of the format, as cv::imencode takes them
/// @throws InputError if it cannot be written.
void write_picture(const std::filesystem::path& file, const cv::Mat& bgr,
                   const std::vector<int>& settings = {});

/// Whether a PNG or JPEG file is there and as whole as picture_fault() can tell.
bool is_whole_picture(const std::filesystem::path& file);

}  // namespace mh
