// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "scenes/recordings/messages/wire.hpp"
#include "slam/core/grid2d.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// The color image in a message: rgb8, bgr8, rgba8, bgra8, mono8 and their generic names (8UC3
/// etc.), rgb16, bgr16, mosaics (bayer_rggb8 and so on, bilinear), yuv422 (UYVY), yuv422_yuy2
/// (YUYV), nv12, nv21, or JPEG and PNG. @throws InputError "encoding ..." or "is ..." if it cannot
/// be read.
Grid2d<Rgb8> color_in(std::string_view message, ros::Wire wire, bool compressed);

/// Whether a format of CompressedImage is that of image_transport's compressedDepth, which writes a
/// header before the PNG.
inline bool is_compressed_depth(const std::string& format) {
  return format.find("compressedDepth") != std::string::npos;
}
inline constexpr std::size_t kDepthHead = 12;  ///< bytes

/// Units per meter of integer depth unless stated otherwise: millimeters (REP 118).
inline constexpr double kRosDepthPerMeter = 1000;

/// The depth image in a message, m; 0 where there is no return: 32FC1 (m), 16UC1 and mono16 of
/// either endianness, or PNGs from image_transport's compressedDepth.
/// @param per_meter  units of integer depth per meter
Grid2d<float> depth_in(std::string_view message, ros::Wire wire, bool compressed,
                       double per_meter = kRosDepthPerMeter);

/// The ids in a message: 8UC1, mono8, 16UC1, mono16, or a PNG.
Grid2d<std::uint16_t> ids_in(std::string_view message, ros::Wire wire, bool compressed);

}  // namespace mh
