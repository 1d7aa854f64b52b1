// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <opencv2/core.hpp>

namespace mh {

/// Whether encode_png knows this type of pixel: gray or BGR of 8 bits, gray of 16.
bool is_png_type(int opencv_type);

/// A PNG file of a picture. Rows of 8 bits are packed as differences to the row above, those of 16
/// bits as they are: both take the least time and nearly the least room for what a camera sees, its
/// depth and its labels. Measured against OpenCV's writer in docs/rendering.md.
/// @param picture  of a type that is_png_type() knows, not empty
/// @param level    0 (not packed) to 9 (slowest); the same pixels and level give the same bytes
std::string encode_png(const cv::Mat& picture, int level = 1);

/// The same file with a text in it (chunk tEXt), which viewers pass over.
/// @param png      as encode_png() makes it
/// @param keyword  1 to 79 letters
std::string with_text(std::string png, std::string_view keyword, std::string_view text);

/// The text in a PNG file under that keyword; empty if there is none.
std::string text_in(std::string_view png, std::string_view keyword);

}  // namespace mh
