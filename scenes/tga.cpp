// SPDX-License-Identifier: Apache-2.0
#include "scenes/tga.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

namespace mh {
namespace {

constexpr std::size_t kTgaHeader = 18, kMostTgaPixels = std::size_t{1} << 28;

enum TgaKind { kTgaPalette = 1, kTgaColor = 2, kTgaGray = 3 };
constexpr int kRunLengths = 8;  // added to the kind if run-length encoded

/// Content of a header: where the palette and the pixels are, and how they are written.
struct TgaHeader {
  int kind = 0;  ///< kTgaPalette, kTgaColor or kTgaGray
  bool run_lengths = false;
  int width = 0, height = 0;
  std::size_t pixel_bytes = 0;  ///< as written: a palette's index, or a color
  std::size_t colors = 0;       ///< in the palette
  std::size_t color_bytes = 0;  ///< of a color
  std::size_t first_color = 0;  ///< index of the palette's first color
  bool has_opacity = false, from_right = false, from_top = false;
  std::size_t palette_at = 0, pixels_at = 0;
};

std::optional<TgaHeader> header_of_tga(std::string_view bytes) {
  if (bytes.size() < kTgaHeader) return std::nullopt;
  const auto byte = [&](std::size_t at) {
    return static_cast<std::size_t>(static_cast<unsigned char>(bytes[at]));
  };
  const auto word = [&](std::size_t at) { return byte(at) | byte(at + 1) << 8; };
  TgaHeader header;
  header.run_lengths = (byte(2) & kRunLengths) != 0;
  header.kind = static_cast<int>(byte(2)) & ~kRunLengths;
  header.width = static_cast<int>(word(12));
  header.height = static_cast<int>(word(14));
  header.has_opacity = (byte(17) & 0x0f) != 0;
  header.from_right = (byte(17) & 0x10) != 0;
  header.from_top = (byte(17) & 0x20) != 0;
  header.pixel_bytes = (byte(16) + 7) / 8;
  header.first_color = word(3);
  header.colors = byte(1) == 1 ? word(5) : 0;
  const std::size_t palette_bytes = (byte(7) + 7) / 8;
  header.color_bytes = header.kind == kTgaPalette ? palette_bytes : header.pixel_bytes;
  header.palette_at = kTgaHeader + byte(0);
  header.pixels_at = header.palette_at + header.colors * palette_bytes;
  const bool is_color = header.color_bytes >= 2 && header.color_bytes <= 4;
  const bool fits = header.kind == kTgaColor ? is_color
                    : header.kind == kTgaPalette
                        ? is_color && header.pixel_bytes == 1 && header.colors > 0
                    : header.kind == kTgaGray ? header.pixel_bytes == 1
                                              : false;
  if (!fits || byte(1) > 1 || header.width == 0 || header.height == 0 ||
      header.pixels_at > bytes.size())
    return std::nullopt;
  return header;
}

/// The pixels as written, in file order; empty if the bytes end too early.
std::vector<char> pixels_of_tga(const TgaHeader& header, std::string_view bytes) {
  constexpr std::size_t kLongestRun = 128;
  const std::size_t size = header.pixel_bytes;
  const std::size_t count =
      static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height);
  bytes.remove_prefix(header.pixels_at);
  if (count > kMostTgaPixels || count > bytes.size() * (header.run_lengths ? kLongestRun : 1))
    return {};
  std::vector<char> pixels;
  pixels.reserve(count * size);
  if (!header.run_lengths) {
    if (bytes.size() / size < count) return {};
    pixels.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count * size));
    return pixels;
  }
  while (pixels.size() < count * size) {
    if (bytes.empty()) return {};
    const auto head = static_cast<unsigned char>(bytes[0]);
    const std::size_t run =
        std::min<std::size_t>((head & 0x7f) + std::size_t{1}, count - pixels.size() / size);
    const bool repeats = (head & 0x80) != 0;
    const std::size_t taken = (repeats ? 1 : run) * size;
    if (bytes.size() < 1 + taken) return {};
    const std::string_view data = bytes.substr(1, taken);
    for (std::size_t i = 0; i < (repeats ? run : 1); ++i)
      pixels.insert(pixels.end(), data.begin(), data.end());
    bytes.remove_prefix(1 + taken);
  }
  return pixels;
}

/// Blue, green, red, opacity.
std::array<std::uint8_t, 4> color_at(const char* at, std::size_t bytes) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(at[i]); };
  if (bytes == 3) return {byte(0), byte(1), byte(2), 255};
  if (bytes == 4) return {byte(0), byte(1), byte(2), byte(3)};
  const unsigned bits = byte(0) | static_cast<unsigned>(byte(1)) << 8;  // 5 bits of each
  const auto level = [&](int from) {
    return static_cast<std::uint8_t>(((bits >> from) & 31U) * 255U / 31U);
  };
  return {level(0), level(5), level(10), 255};
}

}  // namespace

cv::Mat decode_tga(std::string_view bytes) {
  const auto header = header_of_tga(bytes);
  if (!header) return {};
  const std::vector<char> pixels = pixels_of_tga(*header, bytes);
  if (pixels.empty()) return {};
  const int channels = header->kind == kTgaGray                          ? 1
                       : header->color_bytes == 4 && header->has_opacity ? 4
                                                                         : 3;
  cv::Mat image(header->height, header->width, CV_8UC(channels));
  const char* at = pixels.data();
  for (int row = 0; row < header->height; ++row)
    for (int column = 0; column < header->width; ++column, at += header->pixel_bytes) {
      const char* color = at;
      if (header->kind == kTgaPalette) {
        const std::size_t index = static_cast<unsigned char>(*at) - header->first_color;
        if (index >= header->colors) return {};
        color = bytes.data() + header->palette_at + index * header->color_bytes;
      }
      std::uint8_t* to =
          image.ptr(header->from_top ? row : header->height - 1 - row) +
          std::ptrdiff_t{channels} * (header->from_right ? header->width - 1 - column : column);
      if (channels == 1)
        *to = static_cast<std::uint8_t>(*color);
      else
        std::copy_n(color_at(color, header->color_bytes).begin(), channels, to);
    }
  return image;
}

}  // namespace mh
