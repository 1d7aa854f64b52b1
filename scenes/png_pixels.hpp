// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <opencv2/core.hpp>

namespace mh {

/// Decodes a PNG of the kinds that cameras record (gray or color of 8 bits, gray of 16; not
/// interlaced, no transparent color) in half of the time that OpenCV takes: SLAM on a recording
/// spends most of its time on decoding. Channels are in OpenCV's order.
/// @param bytes  their checksums are not checked
/// @returns an empty image for anything else, and for data that does not decompress to an image of
/// the declared size
cv::Mat decode_plain_png(std::string_view bytes);

}  // namespace mh
