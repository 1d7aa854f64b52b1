// SPDX-License-Identifier: Apache-2.0
#include "scenes/image_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "scenes/png_chunks.hpp"
#include "scenes/png_pixels.hpp"
#include "scenes/tga.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/narrowed.hpp"

namespace mh {
namespace {

std::uint32_t big_endian(std::string_view bytes, std::size_t at, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i)
    value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
  return value;
}

/// Walks a JPEG's segments to its frame header (ITU-T T.81, annex B).
std::optional<ImageSize> jpeg_size(std::string_view bytes) {
  std::size_t at = 2;
  while (at + 4 <= bytes.size() && bytes[at] == '\xff') {
    const auto marker = static_cast<unsigned char>(bytes[at + 1]);
    if (marker == 0xff) {  // fill byte
      ++at;
      continue;
    }
    const bool frame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame && at + 9 <= bytes.size())
      return ImageSize{big_endian(bytes, at + 7, 2), big_endian(bytes, at + 5, 2)};
    if (marker == 0xd9 || marker == 0xda) break;  // end of image, start of data
    at += 2 + big_endian(bytes, at + 2, 2);
  }
  return std::nullopt;
}

/// Whether a JPEG's data continues to its end marker; inside the data, 0xff never precedes 0xd9.
bool jpeg_is_whole(std::string_view bytes) {
  std::size_t at = 2;
  while (at + 2 <= bytes.size()) {
    if (bytes[at] != '\xff') {  // data, or bytes that a decoder would skip
      at = bytes.find('\xff', at);
      if (at == bytes.npos) return false;
      continue;
    }
    const auto marker = static_cast<unsigned char>(bytes[at + 1]);
    if (marker == 0xd9) return true;
    const bool alone = marker <= 0x01 || (marker >= 0xd0 && marker <= 0xd8);
    if (marker == 0xff)
      ++at;
    else if (alone)
      at += 2;
    else if (at + 4 <= bytes.size())
      at += 2 + big_endian(bytes, at + 2, 2);
    else
      return false;
  }
  return false;
}

/// Checks a PNG's chunks up to IEND, with their checksums.
const char* png_fault(std::string_view bytes) {
  std::string_view left = png_chunks(bytes);
  while (const auto chunk = next_png_chunk(left)) {
    const auto* summed = reinterpret_cast<const Bytef*>(chunk->summed.data());
    if (crc32(0, summed, static_cast<uInt>(chunk->summed.size())) != chunk->checksum)
      return "is damaged: its checksum is wrong";
    if (chunk->type == "IEND") return nullptr;
  }
  return "is truncated";
}

/// Number of bytes that a pixel of a JPEG or PNG takes once it is decoded.
std::uint64_t bytes_per_pixel(std::string_view bytes) {
  constexpr std::size_t kBits = 24, kColorType = 25;  // offsets in a PNG
  if (bytes.starts_with("\xff\xd8") || bytes.size() <= kColorType) return 3;
  const int type = bytes[kColorType];  // 0 gray, 2 color, 3 palette; + 4 with opacity
  return (type == 0 ? 1U : type >= 4 ? 4U : 3U) * (bytes[kBits] == 16 ? 2U : 1U);
}

/// Decodes a JPEG or PNG; empty if the bytes are neither, or if decode_image() refuses them.
cv::Mat decode(std::string_view bytes) {
  if (!declared_size(bytes)) return {};
  try {
    return decode_image(bytes);
  } catch (const InputError&) {
    return {};
  }
}

std::string encode(const char* ending, const cv::Mat& image, const std::vector<int>& options) {
  std::vector<unsigned char> bytes;
  cv::imencode(ending, image, bytes, options);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

std::optional<ImageSize> declared_size(std::string_view bytes) {
  if (bytes.size() > std::numeric_limits<int>::max()) return std::nullopt;
  if (bytes.starts_with("\xff\xd8")) return jpeg_size(bytes);
  if (bytes.starts_with("\x89PNG\r\n\x1a\n") && bytes.size() >= 24)
    return ImageSize{big_endian(bytes, 16, 4), big_endian(bytes, 20, 4)};
  return std::nullopt;
}

const char* image_fault(std::string_view bytes) {
  if (bytes.starts_with("\xff\xd8")) return jpeg_is_whole(bytes) ? nullptr : "is truncated";
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return png_fault(bytes);
  if (bytes.starts_with("\xabKTX ")) return "is KTX (Basis Universal), which is not read: use PNG";
  if (bytes.starts_with("GIF8")) return "is GIF, which is not read: use PNG";
  if (bytes.starts_with("DDS ")) return "is DDS, which is not read: use PNG";
  if (bytes.substr(0, 12).ends_with("ftypavif")) return "is AVIF, which is not read: use PNG";
  return nullptr;
}

std::string without_remarks(std::string_view bytes) {
  constexpr std::size_t kSignature = 8, kFrame = 12;  // length, type and sum of a chunk
  if (!bytes.starts_with("\x89PNG\r\n\x1a\n")) return std::string(bytes);
  std::string kept(bytes.substr(0, kSignature));
  for (std::size_t at = kSignature; at + kFrame <= bytes.size();) {
    const std::size_t length =
        std::min<std::size_t>(big_endian(bytes, at, 4), bytes.size() - at - kFrame);
    const std::string_view type = bytes.substr(at + 4, 4);
    // A capital first letter marks a critical chunk; tRNS holds the opacity.
    if ((type[0] >= 'A' && type[0] <= 'Z') || type == "tRNS")
      kept += bytes.substr(at, kFrame + length);
    at += kFrame + length;
  }
  return kept;
}

bool claims_too_much(std::string_view bytes) {
  // An image of one color is the extreme case: a byte of deflate expands to at most 1032 bytes, and
  // a JPEG's block of 256 pixels takes a few bytes.
  constexpr std::uint64_t kMostPixels = 1U << 28, kMostPixelsPerByte = 2048, kMostBytes = 1U << 30;
  const auto size = declared_size(bytes);
  if (!size) return false;
  const std::uint64_t pixels = std::uint64_t{size->width} * size->height;
  return pixels > kMostPixels || pixels / kMostPixelsPerByte > bytes.size() ||
         pixels * bytes_per_pixel(bytes) > kMostBytes;
}

cv::Mat decode_image(std::string_view bytes, ImageForm form) {
  const int flags = form == ImageForm::kStored  ? cv::IMREAD_UNCHANGED
                    : form == ImageForm::kColor ? cv::IMREAD_COLOR
                                                : cv::IMREAD_GRAYSCALE;
  if (const char* fault = image_fault(bytes)) throw InputError(fault);
  if (claims_too_much(bytes)) {
    const auto size = declared_size(bytes);
    throw InputError(
        fmt::format("declares {} x {} pixels, more than its {} bytes can hold or the limit allows",
                    size->width, size->height, bytes.size()));
  }
  if (form == ImageForm::kStored)
    if (cv::Mat image = decode_plain_png(bytes); !image.empty()) return image;
  const std::string quiet = without_remarks(bytes);
  const auto count = narrowed<int>(quiet.size());
  cv::Mat image;
  if (count && *count > 0) try {
      const cv::Mat view(1, *count, CV_8UC1, const_cast<char*>(quiet.data()));
      image = cv::imdecode(view, flags);
    } catch (const cv::Exception&) {  // beyond OpenCV's own limits
    }
  if (image.empty() && form == ImageForm::kStored) image = decode_tga(bytes);
  if (image.empty()) throw InputError("is not an image, or is damaged");
  return image;
}

cv::Mat read_image(const std::filesystem::path& file, ImageForm form) {
  try {
    return decode_image(read_file(file), form);
  } catch (const InputError& error) {
    const std::string_view what = error.what();
    if (what.starts_with(file.string())) throw;
    throw InputError(fmt::format("{}: {}", file.string(), what));
  }
}

Grid2d<Rgb8> color_of(const cv::Mat& bgr) {
  Grid2d<Rgb8> image(bgr.cols, bgr.rows);
  cv::Mat rgb(bgr.rows, bgr.cols, CV_8UC3, image.data());
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  return image;
}

std::optional<Grid2d<Rgb8>> decode_color(std::string_view bytes) {
  const cv::Mat bgr = decode(bytes);
  if (bgr.empty() || bgr.type() != CV_8UC3) return std::nullopt;
  return color_of(bgr);
}

std::optional<Grid2d<std::uint16_t>> decode_gray16(std::string_view bytes) {
  const cv::Mat gray = decode(bytes);
  if (gray.empty() || (gray.type() != CV_8UC1 && gray.type() != CV_16UC1)) return std::nullopt;
  Grid2d<std::uint16_t> image(gray.cols, gray.rows);
  cv::Mat out(gray.rows, gray.cols, CV_16UC1, image.data());
  gray.convertTo(out, CV_16U);
  return image;
}

Grid2d<std::uint16_t> decode_depth16(std::string_view bytes) {
  const cv::Mat units = decode_image(bytes);
  if (units.depth() == CV_8U) throw InputError("has 8 bits, depth needs 16");
  if (units.type() != CV_16UC1)
    throw InputError(fmt::format("has {} channels, depth needs one of 16 bits", units.channels()));
  Grid2d<std::uint16_t> image(units.cols, units.rows);
  units.copyTo(cv::Mat(units.rows, units.cols, CV_16UC1, image.data()));
  return image;
}

std::string encode_jpeg(const Grid2d<Rgb8>& image, int quality) {
  const cv::Mat rgb(image.height(), image.width(), CV_8UC3, const_cast<Rgb8*>(image.data()));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  return encode(".jpg", bgr, {cv::IMWRITE_JPEG_QUALITY, quality});
}

std::string encode_png(const Grid2d<std::uint16_t>& image) {
  const cv::Mat gray(image.height(), image.width(), CV_16UC1,
                     const_cast<std::uint16_t*>(image.data()));
  return encode(".png", gray, {cv::IMWRITE_PNG_COMPRESSION, 3});
}

std::string encode_png(const Grid2d<std::uint8_t>& image) {
  const cv::Mat gray(image.height(), image.width(), CV_8UC1,
                     const_cast<std::uint8_t*>(image.data()));
  return encode(".png", gray, {cv::IMWRITE_PNG_COMPRESSION, 3});
}

}  // namespace mh
