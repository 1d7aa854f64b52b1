// SPDX-License-Identifier: Apache-2.0
// PNG (W3C recommendation, third edition): chunks in section 11, filters in section 9.
#include "scenes/png_pixels.hpp"

#include <libdeflate.h>

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "scenes/png_chunks.hpp"

namespace mh {
namespace {

using Byte = std::uint8_t;

struct PlainPng {
  int width = 0, height = 0, channels = 1, bytes_per_channel = 1;
  std::string compressed;
  std::size_t pixel_bytes() const {
    return static_cast<std::size_t>(channels) * static_cast<std::size_t>(bytes_per_channel);
  }
};

/// Reads the header and joins the data; nullopt if the PNG is of a kind that is not decoded here.
std::optional<PlainPng> read_chunks(std::string_view bytes) {
  constexpr std::size_t kHeader = 13;
  if (!bytes.starts_with(kPngSignature)) return std::nullopt;
  PlainPng png;
  std::string_view left = png_chunks(bytes);
  while (const auto chunk = next_png_chunk(left)) {
    const auto& [type, data, summed, checksum] = *chunk;
    if (type == "IHDR") {
      const bool is_first = png.width == 0 && png.compressed.empty();
      if (!is_first || data.size() != kHeader) return std::nullopt;
      const std::uint32_t width = big_endian_32(data, 0), height = big_endian_32(data, 4);
      const int bits = data[8], color = data[9];
      const bool is_plain =
          ((bits == 8 && (color == 0 || color == 2)) || (bits == 16 && color == 0)) &&
          data.substr(10) == std::string_view("\0\0\0", 3);
      if (!is_plain || width == 0 || height == 0 || width > 1U << 20 || height > 1U << 20)
        return std::nullopt;
      png.width = static_cast<int>(width), png.height = static_cast<int>(height);
      png.channels = color == 2 ? 3 : 1, png.bytes_per_channel = bits / 8;
    } else if (type == "IDAT") {
      png.compressed += data;
    } else if (type == "IEND") {
      return png.width > 0 ? std::optional(std::move(png)) : std::nullopt;
    } else if (png.width == 0 || type == "tRNS" ||
               (type != "PLTE" && type[0] >= 'A' && type[0] <= 'Z')) {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

/// The neighbor closest to left + above - upper left; ties go to the left, then to the one above.
int nearest_neighbor(int left, int above, int upper_left) {
  const int to_left = std::abs(above - upper_left), to_above = std::abs(left - upper_left);
  const int to_upper_left = std::abs(left + above - 2 * upper_left);
  if (to_left <= to_above && to_left <= to_upper_left) return left;
  return to_above <= to_upper_left ? above : upper_left;
}

/// Undoes a row's filter. @returns false if there is no such filter.
template <std::size_t kPixel>
bool unfilter(Byte filter, Byte* row, const Byte* above, std::size_t size) {
  const auto left = [&](std::size_t i) { return i < kPixel ? Byte{0} : row[i - kPixel]; };
  const auto upper_left = [&](std::size_t i) { return i < kPixel ? Byte{0} : above[i - kPixel]; };
  const auto add = [&](const auto& predicted) {
    for (std::size_t i = 0; i < size; ++i) row[i] = static_cast<Byte>(row[i] + predicted(i));
  };
  switch (filter) {
    case 0:
      return true;
    case 1:
      add([&](std::size_t i) { return left(i); });
      return true;
    case 2:
      for (std::size_t i = 0; i < size; ++i) row[i] = static_cast<Byte>(row[i] + above[i]);
      return true;
    case 3:
      add([&](std::size_t i) { return (left(i) + above[i]) / 2; });
      return true;
    case 4:
      add([&](std::size_t i) { return nearest_neighbor(left(i), above[i], upper_left(i)); });
      return true;
    default:
      return false;
  }
}

template <std::size_t kPixel>
bool unfilter_all(std::vector<Byte>& rows, std::size_t size, int height) {
  const std::vector<Byte> nothing(size, 0);
  const Byte* above = nothing.data();
  for (int y = 0; y < height; ++y) {
    Byte* row = rows.data() + static_cast<std::size_t>(y) * (size + 1);
    if (!unfilter<kPixel>(row[0], row + 1, above, size)) return false;
    above = row + 1;
  }
  return true;
}

}  // namespace

cv::Mat decode_plain_png(std::string_view bytes) {
  const auto png = read_chunks(bytes);
  if (!png) return {};
  const std::size_t size = static_cast<std::size_t>(png->width) * png->pixel_bytes();
  const std::size_t all = (size + 1) * static_cast<std::size_t>(png->height);
  constexpr std::size_t kMostOfAByte = 1032;  // to which deflate expands one
  if (all / kMostOfAByte > png->compressed.size()) return {};
  std::vector<Byte> rows(all);
  const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> inflate(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (inflate == nullptr ||
      libdeflate_zlib_decompress(inflate.get(), png->compressed.data(), png->compressed.size(),
                                 rows.data(), rows.size(), nullptr) != LIBDEFLATE_SUCCESS)
    return {};
  const bool known = png->pixel_bytes() == 1   ? unfilter_all<1>(rows, size, png->height)
                     : png->pixel_bytes() == 2 ? unfilter_all<2>(rows, size, png->height)
                                               : unfilter_all<3>(rows, size, png->height);
  if (!known) return {};
  const int depth = png->bytes_per_channel == 2 ? CV_16U : CV_8U;
  cv::Mat image(png->height, png->width, CV_MAKETYPE(depth, png->channels));
  const cv::Mat pixels(png->height, png->width,
                       depth == CV_16U ? CV_8UC2 : CV_MAKETYPE(CV_8U, png->channels),
                       rows.data() + 1, size + 1);
  if (png->channels == 3) {
    cv::cvtColor(pixels, image, cv::COLOR_RGB2BGR);
  } else if (depth == CV_8U) {
    pixels.copyTo(image);
  } else {
    for (int y = 0; y < png->height; ++y) {
      const auto* from = pixels.ptr<Byte>(y);
      auto* to = image.ptr<std::uint16_t>(y);
      for (int x = 0; x < png->width; ++x)
        to[x] = static_cast<std::uint16_t>(from[2 * x] << 8 | from[2 * x + 1]);
    }
  }
  return image;
}

}  // namespace mh
