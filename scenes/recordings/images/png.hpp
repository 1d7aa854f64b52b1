// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <opencv2/core.hpp>

namespace mh {

/// Whether encode_png supports this pixel type: gray or BGR of 8 bits, gray of 16.
bool is_png_type(int opencv_type);

/// Encodes an image as PNG. Rows of 8 bits are stored as differences to the row above, those of 16
/// bits unfiltered: both are the fastest choice and nearly the smallest for camera images, depth
/// and labels. Compared with OpenCV's writer in docs/measurements/rendering.md.
/// @param image  of a type that is_png_type() supports, not empty
/// @param level    0 (uncompressed) to 9 (slowest); the same pixels and level give the same bytes
std::string encode_png(const cv::Mat& image, int level = 1);

/// The same file with an embedded text (chunk tEXt), which viewers ignore.
/// @param png      as encode_png() makes it
/// @param keyword  1 to 79 letters
std::string with_text(std::string png, std::string_view keyword, std::string_view text);

/// The text in a PNG file under that keyword; empty if there is none.
std::string text_in(std::string_view png, std::string_view keyword);

}  // namespace mh
