// SPDX-License-Identifier: Apache-2.0
#include "bench/pictures/png.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <memory>
#include <new>
#include <string_view>
#include <utility>
#include <vector>

namespace mh {
namespace {

using Bytes = std::vector<std::uint8_t>;

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

/// A row in the file's order: RGB, and of 16 bits the upper byte first.
void read_row(const cv::Mat& picture, int y, Bytes& row) {
  const std::uint8_t* from = picture.ptr(y);
  if (picture.type() == CV_8UC1) {
    std::copy_n(from, row.size(), row.begin());
  } else if (picture.type() == CV_16UC1) {
    for (std::size_t i = 0; i < row.size(); i += 2) row[i] = from[i + 1], row[i + 1] = from[i];
  } else {
    for (std::size_t i = 0; i < row.size(); i += 3)
      row[i] = from[i + 2], row[i + 1] = from[i + 1], row[i + 2] = from[i];
  }
}

/// All rows, each behind the number of its filter (0 none, 2 less the row above).
Bytes filtered(const cv::Mat& picture) {
  const bool less_above = picture.depth() == CV_8U;
  const std::size_t width = static_cast<std::size_t>(picture.cols) * picture.elemSize();
  Bytes row(width), above(width), out((width + 1) * static_cast<std::size_t>(picture.rows));
  std::uint8_t* to = out.data();
  for (int y = 0; y < picture.rows; ++y) {
    read_row(picture, y, row);
    *to++ = less_above ? 2 : 0;
    for (std::size_t i = 0; i < width; ++i)
      to[i] = static_cast<std::uint8_t>(row[i] - (less_above ? above[i] : 0));
    to += width;
    std::swap(row, above);
  }
  return out;
}

std::string packed(const Bytes& bytes, int level) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(level), libdeflate_free_compressor);
  if (compressor == nullptr) throw std::bad_alloc();
  std::string out(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()), '\0');
  out.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), out.data(),
                                      out.size()));
  return out;
}

}  // namespace

bool is_png_type(int opencv_type) {
  return opencv_type == CV_8UC1 || opencv_type == CV_8UC3 || opencv_type == CV_16UC1;
}

std::string encode_png(const cv::Mat& picture, int level) {
  assert(is_png_type(picture.type()) && !picture.empty() && level >= 0 && level <= 9);
  std::string header;
  append_be32(header, static_cast<std::size_t>(picture.cols));
  append_be32(header, static_cast<std::size_t>(picture.rows));
  header += static_cast<char>(picture.depth() == CV_16U ? 16 : 8);  // bits
  header += static_cast<char>(picture.channels() == 3 ? 2 : 0);     // colour or grey
  header += std::string(3, '\0');  // the one way to pack, the one set of filters, not interlaced
  std::string file = "\x89PNG\r\n\x1A\n";
  append_chunk(file, "IHDR", header);
  append_chunk(file, "IDAT", packed(filtered(picture), level));
  append_chunk(file, "IEND", {});
  return file;
}

}  // namespace mh
