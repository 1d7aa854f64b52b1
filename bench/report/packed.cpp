// SPDX-License-Identifier: Apache-2.0
#include "bench/report/packed.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "scenes/image_file.hpp"

namespace mh {

void put(std::vector<std::uint8_t>& bytes, std::uint32_t value, int count) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

std::string base64(std::string_view bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < left ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= left ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  return base64(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

std::string small_jpeg(const Grid2d<Rgb8>& image, int width_px) {
  constexpr int kQuality = 72;
  const double scale = std::min(1.0, static_cast<double>(width_px) / image.width());
  const cv::Mat whole(image.height(), image.width(), CV_8UC3, const_cast<Rgb8*>(image.data()));
  Grid2d<Rgb8> small(static_cast<int>(std::lround(image.width() * scale)),
                     static_cast<int>(std::lround(image.height() * scale)));
  cv::Mat out(small.height(), small.width(), CV_8UC3, small.data());
  cv::resize(whole, out, out.size(), 0, 0, cv::INTER_AREA);
  return base64(encode_jpeg(small, kQuality));
}

}  // namespace mh
