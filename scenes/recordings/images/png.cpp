// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/images/png.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <memory>
#include <new>
#include <string_view>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "scenes/png_chunks.hpp"

namespace mh {
namespace {

void append_be32(std::string& out, std::size_t value) {
  for (const int shift : {24, 16, 8, 0}) out += static_cast<char>(value >> shift & 0xFF);
}

void append_chunk(std::string& out, std::string_view name, std::string_view data) {
  append_be32(out, data.size());
  const std::size_t begin = out.size();
  out += name;
  out += data;
  append_be32(out, libdeflate_crc32(0, out.data() + begin, out.size() - begin));
}

/// All rows in the file's order (RGB, and for 16 bits the upper byte first), each preceded by its
/// filter number: 2 (difference from the row above) for 8 bits, 0 (none) for 16.
std::vector<std::uint8_t> filtered(const cv::Mat& image) {
  cv::Mat rgb;
  if (image.type() == CV_8UC3) cv::cvtColor(image, rgb, cv::COLOR_BGR2RGB);
  const cv::Mat& pixels = rgb.empty() ? image : rgb;
  const std::size_t width = static_cast<std::size_t>(image.cols) * image.elemSize();
  std::vector<std::uint8_t> out((width + 1) * static_cast<std::size_t>(image.rows));
  std::uint8_t* to = out.data();
  for (int y = 0; y < image.rows; ++y) {
    const std::uint8_t* row = pixels.ptr(y);
    const std::uint8_t* above = y > 0 ? pixels.ptr(y - 1) : nullptr;
    const bool bytes = image.depth() == CV_8U;
    *to++ = bytes ? 2 : 0;
    if (!bytes)
      for (std::size_t i = 0; i < width; i += 2) to[i] = row[i + 1], to[i + 1] = row[i];
    else if (above == nullptr)
      std::copy_n(row, width, to);
    else
      for (std::size_t i = 0; i < width; ++i) to[i] = static_cast<std::uint8_t>(row[i] - above[i]);
    to += width;
  }
  return out;
}

struct FreeCompressor {
  void operator()(libdeflate_compressor* compressor) const {
    libdeflate_free_compressor(compressor);
  }
};

/// The compressor of this thread for a level, created on first use: creating it costs as much as
/// compressing a small image.
libdeflate_compressor* compressor_of(int level) {
  thread_local std::array<std::unique_ptr<libdeflate_compressor, FreeCompressor>, 10> compressors;
  auto& compressor = compressors.at(static_cast<std::size_t>(level));
  if (compressor == nullptr) compressor.reset(libdeflate_alloc_compressor(level));
  if (compressor == nullptr) throw std::bad_alloc();
  return compressor.get();
}

/// Appends a chunk of compressed bytes.
void append_packed(std::string& file, const std::vector<std::uint8_t>& bytes, int level) {
  libdeflate_compressor* compressor = compressor_of(level);
  const std::size_t most = libdeflate_zlib_compress_bound(compressor, bytes.size());
  const auto packed = std::make_unique_for_overwrite<char[]>(most);
  const std::size_t size =
      libdeflate_zlib_compress(compressor, bytes.data(), bytes.size(), packed.get(), most);
  append_chunk(file, "IDAT", {packed.get(), size});
}

}  // namespace

bool is_png_type(int opencv_type) {
  return opencv_type == CV_8UC1 || opencv_type == CV_8UC3 || opencv_type == CV_16UC1;
}

std::string encode_png(const cv::Mat& image, int level) {
  assert(is_png_type(image.type()) && !image.empty() && level >= 0 && level <= 9);
  std::string header;
  append_be32(header, static_cast<std::size_t>(image.cols));
  append_be32(header, static_cast<std::size_t>(image.rows));
  header += static_cast<char>(image.depth() == CV_16U ? 16 : 8);  // bits
  header += static_cast<char>(image.channels() == 3 ? 2 : 0);     // color or gray
  header += std::string(3, '\0');  // compression method 0, filter method 0, not interlaced
  std::string file = "\x89PNG\r\n\x1A\n";
  append_chunk(file, "IHDR", header);
  append_packed(file, filtered(image), level);
  append_chunk(file, "IEND", {});
  return file;
}

std::string with_text(std::string png, std::string_view keyword, std::string_view text) {
  constexpr std::size_t kEnd_bytes = 12;  // the chunk IEND
  assert(png.size() > kEnd_bytes && png.substr(png.size() - 8, 4) == "IEND");
  std::string chunk, content(keyword);
  content += '\0';
  content += text;
  append_chunk(chunk, "tEXt", content);
  return png.insert(png.size() - kEnd_bytes, chunk);
}

std::string text_in(std::string_view png, std::string_view keyword) {
  std::string_view left = png_chunks(png);
  while (const auto chunk = next_png_chunk(left)) {
    const std::string_view content = chunk->data;
    if (chunk->type == "tEXt" && content.starts_with(keyword) && content.size() > keyword.size() &&
        content[keyword.size()] == '\0')
      return std::string(content.substr(keyword.size() + 1));
  }
  return {};
}

}  // namespace mh
