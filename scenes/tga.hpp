// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace cv {
class Mat;
}

namespace mh {

/// Decodes a Truevision TGA, a format that OpenCV does not read and that Collada and OBJ models
/// often use: gray, color, with a palette, run-length encoded or not. TGA has no signature: try the
/// other formats first.
/// @returns 1, 3 or 4 channels of 8 bits in OpenCV's order; empty if the bytes are not a complete
/// TGA
cv::Mat decode_tga(std::string_view bytes);

}  // namespace mh
