// SPDX-License-Identifier: Apache-2.0
#include "scenes/recorded/ros/image.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "scenes/image_file.hpp"
#include "slam/core/error.hpp"

namespace mh {
namespace {

constexpr std::uint32_t kLargestSide_px = 65535;

/// An image message whose size fits its data.
ros::Image checked_image(std::string_view message, ros::Wire wire, std::size_t bytes_per_pixel) {
  auto image = ros::parsed<ros::Image>(message, wire);
  if (image.width == 0 || image.height == 0 || image.width > kLargestSide_px ||
      image.height > kLargestSide_px)
    throw InputError(fmt::format("is of {} x {} pixels", image.width, image.height));
  const std::uint64_t row = bytes_per_pixel * image.width;
  if (image.step < row || std::uint64_t{image.step} * (image.height - 1) + row > image.data.size())
    throw InputError(fmt::format("holds {} bytes, too few for {} x {} pixels of {} in rows of {}",
                                 image.data.size(), image.width, image.height, bytes_per_pixel,
                                 image.step));
  return image;
}

std::string encoding_of(std::string_view message, ros::Wire wire) {
  return ros::parsed<ros::Image>(message, wire).encoding;
}

/// Calls set(element of the grid, its bytes) for each pixel.
template <class T>
Grid2d<T> pixels(const ros::Image& image, std::size_t bytes_per_pixel, const auto& get) {
  Grid2d<T> grid(static_cast<int>(image.width), static_cast<int>(image.height));
  for (int y = 0; y < grid.height(); ++y) {
    const char* at = image.data.data() + std::size_t{image.step} * static_cast<std::size_t>(y);
    for (int x = 0; x < grid.width(); ++x, at += bytes_per_pixel) grid(x, y) = get(at);
  }
  return grid;
}

template <class T>
T number_at(const char* bytes, bool is_bigendian) {
  char own[sizeof(T)];
  std::memcpy(own, bytes, sizeof(T));
  if (is_bigendian) std::reverse(own, own + sizeof(T));
  return std::bit_cast<T>(own);
}

/// Places of red, green and blue in a pixel.
struct ColorLayout {
  std::size_t bytes, r, g, b;
};

std::optional<ColorLayout> color_layout(const std::string& encoding) {
  if (encoding == "rgb8") return ColorLayout{3, 0, 1, 2};
  if (encoding == "bgr8" || encoding == "8UC3") return ColorLayout{3, 2, 1, 0};
  if (encoding == "rgba8") return ColorLayout{4, 0, 1, 2};
  if (encoding == "bgra8" || encoding == "8UC4") return ColorLayout{4, 2, 1, 0};
  if (encoding == "mono8" || encoding == "8UC1") return ColorLayout{1, 0, 0, 0};
  return std::nullopt;
}

[[noreturn]] void refuse(const std::string& encoding, const char* what) {
  throw InputError(fmt::format("encoding '{}' is not read as {}", encoding, what));
}

float meters_of(std::uint16_t millimeters) {
  return static_cast<float>(millimeters / 1000.0);
}
float meters_of(float depth_m) {
  return std::isfinite(depth_m) && depth_m > 0 ? depth_m : 0;
}

/// What image_transport's plugin puts before the PNG: a number for the kind, and the two
/// parameters of inverse depths: depth = a / (value - b).
struct DepthHead {
  std::uint32_t kind = 0;
  float a = 0, b = 0;
};

Grid2d<float> compressed_depth(std::string_view message, ros::Wire wire) {
  const auto image = ros::parsed<ros::CompressedImage>(message, wire);
  const bool has_head = image.format.find("compressedDepth") != std::string::npos;
  if (image.format.find("rvl") != std::string::npos) refuse(image.format, "depth");
  std::string_view png = image.data;
  DepthHead head;
  if (has_head) {
    if (png.size() < sizeof(head)) throw InputError("is shorter than its head");
    std::memcpy(&head, png.data(), sizeof(head));
    png.remove_prefix(sizeof(head));
  }
  const Grid2d<std::uint16_t> values = decode_depth16(png);
  const bool inverse = image.format.starts_with("32FC1");
  Grid2d<float> depth_m(values.width(), values.height());
  std::ranges::transform(values, depth_m.begin(), [&](std::uint16_t v) {
    if (!inverse) return meters_of(v);
    return v == 0 ? 0.0F : meters_of(head.a / (static_cast<float>(v) - head.b));
  });
  return depth_m;
}

}  // namespace

Grid2d<Rgb8> color_in(std::string_view message, ros::Wire wire, bool compressed) {
  if (compressed) {
    const auto image = ros::parsed<ros::CompressedImage>(message, wire);
    if (auto color = decode_color(image.data)) return std::move(*color);
    const auto gray = decode_gray16(image.data);
    if (!gray)
      throw InputError(fmt::format("cannot be decoded as an image (format '{}')", image.format));
    Grid2d<Rgb8> color(gray->width(), gray->height());
    std::ranges::transform(*gray, color.begin(), [](std::uint16_t v) {
      const auto byte = static_cast<std::uint8_t>(std::min<std::uint16_t>(v, 255));
      return Rgb8{byte, byte, byte};
    });
    return color;
  }
  const std::string encoding = encoding_of(message, wire);
  const auto layout = color_layout(encoding);
  if (!layout) refuse(encoding, "color");
  const auto byte = [](char c) { return static_cast<std::uint8_t>(c); };
  return pixels<Rgb8>(checked_image(message, wire, layout->bytes), layout->bytes,
                      [&, l = *layout](const char* at) {
                        return Rgb8{byte(at[l.r]), byte(at[l.g]), byte(at[l.b])};
                      });
}

Grid2d<float> depth_in(std::string_view message, ros::Wire wire, bool compressed) {
  if (compressed) return compressed_depth(message, wire);
  const std::string encoding = encoding_of(message, wire);
  const auto read = [&]<class T>(T) {
    const ros::Image image = checked_image(message, wire, sizeof(T));
    return pixels<float>(image, sizeof(T), [big = image.is_bigendian != 0](const char* at) {
      return meters_of(number_at<T>(at, big));
    });
  };
  if (encoding == "32FC1") return read(float{});
  if (encoding == "16UC1" || encoding == "mono16") return read(std::uint16_t{});
  refuse(encoding, "depth");
}

Grid2d<std::uint16_t> ids_in(std::string_view message, ros::Wire wire, bool compressed) {
  if (compressed) {
    auto ids = decode_gray16(ros::parsed<ros::CompressedImage>(message, wire).data);
    if (!ids) throw InputError("is not a PNG of one channel");
    return std::move(*ids);
  }
  const std::string encoding = encoding_of(message, wire);
  if (encoding != "8UC1" && encoding != "mono8" && encoding != "16UC1" && encoding != "mono16")
    refuse(encoding, "labels");
  const bool wide = encoding.find("16") != std::string::npos;
  const ros::Image image = checked_image(message, wire, wide ? 2 : 1);
  return pixels<std::uint16_t>(image, wide ? 2 : 1, [&](const char* at) {
    return wide ? number_at<std::uint16_t>(at, image.is_bigendian != 0)
                : std::uint16_t{static_cast<std::uint8_t>(*at)};
  });
}

}  // namespace mh
