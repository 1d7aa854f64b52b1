// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Appends a number, the lowest byte first.
void put(std::vector<std::uint8_t>& bytes, std::uint32_t value, int count);

/// Encodes bytes as text, four characters for three bytes (RFC 4648).
std::string base64(const std::vector<std::uint8_t>& bytes);
std::string base64(std::string_view bytes);

/// An image for a page: at most `width_px` wide, as JPEG in base64.
std::string small_jpeg(const Grid2d<Rgb8>& image, int width_px);

}  // namespace mh
