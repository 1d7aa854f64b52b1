// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

namespace mh {

inline constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";

/// The big-endian number of four bytes that begins at a position.
inline std::uint32_t big_endian_32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// A chunk of a PNG (W3C recommendation, third edition, 5.3).
struct PngChunk {
  std::string_view type, data;
  std::string_view summed;  ///< type and data, which the checksum covers
  std::uint32_t checksum = 0;
};

/// The bytes of a PNG after its signature.
inline std::string_view png_chunks(std::string_view png) {
  return png.substr(std::min(png.size(), kPngSignature.size()));
}

/// Takes the first chunk from the chunks that are left; nullopt if there is no whole one.
inline std::optional<PngChunk> next_png_chunk(std::string_view& left) {
  constexpr std::size_t kFrame = 12;  // length, type and checksum
  if (left.size() < kFrame) return std::nullopt;
  const std::size_t length = big_endian_32(left, 0);
  if (length > left.size() - kFrame) return std::nullopt;
  const PngChunk chunk{.type = left.substr(4, 4),
                       .data = left.substr(8, length),
                       .summed = left.substr(4, 4 + length),
                       .checksum = big_endian_32(left, 8 + length)};
  left.remove_prefix(kFrame + length);
  return chunk;
}

}  // namespace mh
