// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <opencv2/core.hpp>

namespace mh {

/// Whether encode_png supports this pixel type: 8-bit gray or BGR, 16-bit gray.
bool is_png_type(int opencv_type);

/// Encodes an image as PNG. 8-bit rows are stored as differences from the row above, 16-bit rows
/// unfiltered: both are the fastest choice, and nearly the smallest for camera images, depth and
/// labels. For a comparison with OpenCV's writer, see docs/measurements/rendering.md.
/// @param image  of a type that is_png_type() supports, not empty
/// @param level    0 (uncompressed) to 9 (slowest); the same pixels and level give the same bytes
std::string encode_png(const cv::Mat& image, int level = 1);

/// The same file with an embedded text (chunk tEXt), which viewers ignore.
/// @param png      as encode_png() returns it
/// @param keyword  1 to 79 letters
std::string with_text(std::string png, std::string_view keyword, std::string_view text);

/// The text with that keyword in a PNG file; empty if there is none.
std::string text_in(std::string_view png, std::string_view keyword);

}  // namespace mh
