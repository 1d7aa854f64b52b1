// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <opencv2/core.hpp>

namespace mh {

/// Decodes a PNG of the kinds that cameras record (gray or color of 8 bits, gray of 16; not
/// interlaced, no transparent color) in half of OpenCV's time, which is most of the time that SLAM
/// on a recording takes. Channels are in OpenCV's order.
/// @param bytes  their checksums are not checked
/// @returns an empty image for anything else, and for data that does not decompress to this image
cv::Mat decode_plain_png(std::string_view bytes);

}  // namespace mh
