// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/ros/image.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "scenes/image_file.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr std::uint32_t kLargestSide_px = 65535;

/// @param rows  number of rows of bytes in the data
/// @throws InputError if the image's size does not fit its data.
void check_size(const ros::Image& image, std::size_t bytes_per_pixel, std::uint64_t rows) {
  if (image.width == 0 || image.height == 0 || image.width > kLargestSide_px ||
      image.height > kLargestSide_px)
    throw InputError(fmt::format("has {} x {} pixels", image.width, image.height));
  const std::uint64_t row = bytes_per_pixel * image.width;
  if (image.step < row || std::uint64_t{image.step} * (rows - 1) + row > image.data.size())
    throw InputError(fmt::format("holds {} bytes, too few for {} x {} pixels of {} in rows of {}",
                                 image.data.size(), image.width, image.height, bytes_per_pixel,
                                 image.step));
}

/// An image message whose size fits its data.
ros::Image checked_image(std::string_view message, ros::Wire wire, std::size_t bytes_per_pixel) {
  auto image = ros::parsed<ros::Image>(message, wire);
  check_size(image, bytes_per_pixel, image.height);
  return image;
}

std::string encoding_of(std::string_view message, ros::Wire wire) {
  return ros::parsed<ros::Image>(message, wire).encoding;
}

/// A grid whose elements are get(the pixel's bytes).
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
  bool wide = false;  ///< 16 bits per channel
};

/// A color encoding that OpenCV converts: how many rows of bytes it has for two rows of the image,
/// how many bytes a row has for two pixels, and OpenCV's code for the conversion to red, green,
/// blue.
struct Conversion {
  const char* encoding;
  int rows_of_2, bytes_of_2;
  int code;
};

// ROS names a mosaic after its first two rows. The names of OpenCV that are used here follow the
// same rule; OpenCV's older names start at the second row and column.
constexpr std::array kConversions = {Conversion{"bayer_rggb8", 2, 2, cv::COLOR_BayerRGGB2RGB},
                                     Conversion{"bayer_bggr8", 2, 2, cv::COLOR_BayerBGGR2RGB},
                                     Conversion{"bayer_gbrg8", 2, 2, cv::COLOR_BayerGBRG2RGB},
                                     Conversion{"bayer_grbg8", 2, 2, cv::COLOR_BayerGRBG2RGB},
                                     Conversion{"yuv422", 2, 4, cv::COLOR_YUV2RGB_UYVY},
                                     Conversion{"uyvy", 2, 4, cv::COLOR_YUV2RGB_UYVY},
                                     Conversion{"yuv422_yuy2", 2, 4, cv::COLOR_YUV2RGB_YUYV},
                                     Conversion{"yuyv", 2, 4, cv::COLOR_YUV2RGB_YUYV},
                                     Conversion{"nv12", 3, 2, cv::COLOR_YUV2RGB_NV12},
                                     Conversion{"nv21", 3, 2, cv::COLOR_YUV2RGB_NV21}};

const Conversion* conversion_of(const std::string& encoding) {
  const auto found =
      std::ranges::find(kConversions, encoding, [](const Conversion& c) { return c.encoding; });
  return found == kConversions.end() ? nullptr : &*found;
}

/// @param stored the rows of bytes, as in the message
Grid2d<Rgb8> converted(const cv::Mat& stored, const Conversion& conversion, int width, int height) {
  const bool mosaic = std::string_view(conversion.encoding).starts_with("bayer");
  if (mosaic ? width < 3 || height < 3 : width % 2 != 0 || height % (conversion.rows_of_2 - 1) != 0)
    throw InputError(fmt::format("has {} x {} pixels, which {} does not allow", width, height,
                                 conversion.encoding));
  Grid2d<Rgb8> color(width, height);
  cv::Mat rgb(height, width, CV_8UC3, color.data());
  cv::cvtColor(stored, rgb, conversion.code);
  return color;
}

Grid2d<Rgb8> converted_color(std::string_view message, ros::Wire wire,
                             const Conversion& conversion) {
  ros::Image image = ros::parsed<ros::Image>(message, wire);
  const std::uint64_t rows =
      image.height / 2 * static_cast<std::uint64_t>(conversion.rows_of_2) + image.height % 2;
  const int channels = conversion.bytes_of_2 / 2;
  check_size(image, static_cast<std::size_t>(channels), rows);
  const cv::Mat stored(static_cast<int>(rows), static_cast<int>(image.width), CV_8UC(channels),
                       const_cast<char*>(image.data.data()), image.step);
  return converted(stored, conversion, static_cast<int>(image.width),
                   static_cast<int>(image.height));
}

std::optional<ColorLayout> color_layout(const std::string& encoding) {
  if (encoding == "rgb8") return ColorLayout{3, 0, 1, 2};
  if (encoding == "bgr8" || encoding == "8UC3") return ColorLayout{3, 2, 1, 0};
  if (encoding == "rgb16") return ColorLayout{6, 0, 2, 4, true};
  if (encoding == "bgr16") return ColorLayout{6, 4, 2, 0, true};
  if (encoding == "rgba8") return ColorLayout{4, 0, 1, 2};
  if (encoding == "bgra8" || encoding == "8UC4") return ColorLayout{4, 2, 1, 0};
  if (encoding == "mono8" || encoding == "8UC1") return ColorLayout{1, 0, 0, 0};
  return std::nullopt;
}

[[noreturn]] void refuse(const std::string& encoding, const char* what) {
  throw InputError(fmt::format("encoding '{}' is not read as {}", encoding, what));
}

float meters_of(std::uint16_t units, double per_meter) {
  return static_cast<float>(units / per_meter);
}
float meters_of(float depth_m, double) {
  return std::isfinite(depth_m) && depth_m > 0 ? depth_m : 0;
}

/// What image_transport's plugin writes before the PNG: a number for the kind, and the two
/// parameters of inverse depth: depth = a / (value - b).
struct DepthHead {
  std::uint32_t kind = 0;
  float a = 0, b = 0;
};
static_assert(sizeof(DepthHead) == kDepthHead);

Grid2d<float> compressed_depth(std::string_view message, ros::Wire wire, double per_meter) {
  const auto image = ros::parsed<ros::CompressedImage>(message, wire);
  const bool has_head = is_compressed_depth(image.format);
  if (image.format.find("rvl") != std::string::npos) refuse(image.format, "depth");
  std::string_view png = image.data;
  DepthHead head;
  if (has_head) {
    if (png.size() < sizeof(head)) throw InputError("is shorter than its header");
    std::memcpy(&head, png.data(), sizeof(head));
    png.remove_prefix(sizeof(head));
  }
  const Grid2d<std::uint16_t> values = decode_depth16(png);
  const bool inverse = image.format.starts_with("32FC1");
  Grid2d<float> depth_m(values.width(), values.height());
  std::ranges::transform(values, depth_m.begin(), [&](std::uint16_t v) {
    if (!inverse) return meters_of(v, per_meter);
    return v == 0 ? 0.0F : meters_of(head.a / (static_cast<float>(v) - head.b), 1);
  });
  return depth_m;
}

/// Decodes a JPEG or PNG. A mosaic is stored as a gray image; its format is "bayer_rggb8; png
/// compressed bayer_rggb8".
Grid2d<Rgb8> compressed_color(const ros::CompressedImage& image) {
  if (auto color = decode_color(image.data)) return std::move(*color);
  auto gray = decode_gray16(image.data);
  if (!gray)
    throw InputError(fmt::format("cannot be decoded as an image (format '{}')", image.format));
  const cv::Mat wide(gray->height(), gray->width(), CV_16UC1, gray->data());
  cv::Mat bytes;
  wide.convertTo(bytes, CV_8U);
  const Conversion* conversion = conversion_of(image.format.substr(0, image.format.find(';')));
  if (conversion != nullptr && conversion->bytes_of_2 == 2 && conversion->rows_of_2 == 2)
    return converted(bytes, *conversion, gray->width(), gray->height());
  Grid2d<Rgb8> color(gray->width(), gray->height());
  cv::cvtColor(bytes, cv::Mat(bytes.size(), CV_8UC3, color.data()), cv::COLOR_GRAY2RGB);
  return color;
}

}  // namespace

Grid2d<Rgb8> color_in(std::string_view message, ros::Wire wire, bool compressed) {
  if (compressed) return compressed_color(ros::parsed<ros::CompressedImage>(message, wire));
  const std::string encoding = encoding_of(message, wire);
  if (const Conversion* conversion = conversion_of(encoding))
    return converted_color(message, wire, *conversion);
  const auto layout = color_layout(encoding);
  if (!layout) refuse(encoding, "color");
  const ros::Image image = checked_image(message, wire, layout->bytes);
  const auto byte = [&](const char* at) {
    if (!layout->wide) return static_cast<std::uint8_t>(*at);
    return static_cast<std::uint8_t>(number_at<std::uint16_t>(at, image.is_bigendian != 0) >> 8);
  };
  return pixels<Rgb8>(image, layout->bytes, [&](const char* at) {
    return Rgb8{byte(at + layout->r), byte(at + layout->g), byte(at + layout->b)};
  });
}

Grid2d<float> depth_in(std::string_view message, ros::Wire wire, bool compressed,
                       double per_meter) {
  if (compressed) return compressed_depth(message, wire, per_meter);
  const std::string encoding = encoding_of(message, wire);
  const auto read = [&]<class T>(T) {
    const ros::Image image = checked_image(message, wire, sizeof(T));
    return pixels<float>(image, sizeof(T), [&](const char* at) {
      return meters_of(number_at<T>(at, image.is_bigendian != 0), per_meter);
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
