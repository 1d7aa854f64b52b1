// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "scenes/messages/wire.hpp"
#include "slam/core/grid2d.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// The color image in a message: rgb8, bgr8, rgba8, bgra8, mono8 and their plain names, or JPEG and
/// PNG. @throws InputError "encoding ..." or "is ..." if it cannot be read.
Grid2d<Rgb8> color_in(std::string_view message, ros::Wire wire, bool compressed);

/// The depth image in a message, m; 0 where there is no return: 32FC1 (m), 16UC1 and mono16 (mm,
/// REP 118) of either endianness, or PNGs of image_transport's compressedDepth.
Grid2d<float> depth_in(std::string_view message, ros::Wire wire, bool compressed);

/// The ids in a message: 8UC1, mono8, 16UC1, mono16, or a PNG.
Grid2d<std::uint16_t> ids_in(std::string_view message, ros::Wire wire, bool compressed);

}  // namespace mh
