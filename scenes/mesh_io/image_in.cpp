// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/image_in.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "scenes/image_file.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/held_bytes.hpp"

namespace mh {
namespace {

/// One channel as a separate image.
Grid2d<std::uint8_t> channel_of(const cv::Mat& image, int channel) {
  Grid2d<std::uint8_t> values(image.cols, image.rows);
  cv::Mat out(image.rows, image.cols, CV_8UC1, values.data());
  cv::extractChannel(image, out, channel);
  return values;
}

ImageIn decoded(std::string_view bytes) {
  cv::Mat stored;
  try {
    stored = decode_image(bytes);
  } catch (const InputError& error) {
    return {.fault = error.what()};
  }
  if (stored.depth() == CV_16U) stored.convertTo(stored, CV_8U, 1.0 / 257.0);
  if (stored.depth() != CV_8U) return {};
  Grid2d<Rgb8> color(stored.cols, stored.rows, Unfilled{});
  cv::Mat rgb(stored.rows, stored.cols, CV_8UC3, color.data());
  ImageIn image;
  switch (stored.channels()) {
    case 1:
      cv::cvtColor(stored, rgb, cv::COLOR_GRAY2RGB);
      break;
    case 3:
      cv::cvtColor(stored, rgb, cv::COLOR_BGR2RGB);
      break;
    case 4:
      cv::cvtColor(stored, rgb, cv::COLOR_BGRA2RGB);
      image.opacity = channel_of(stored, 3);
      break;
    default:
      return {};
  }
  image.color = std::move(color);
  return image;
}

}  // namespace

ImageIn ImageStore::decode(std::string_view bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  const auto [place, is_new] = decoded_.try_emplace({hash.high64, hash.low64});
  if (is_new) place->second = decoded(bytes);
  return place->second;
}

ImageIn ImageStore::read(const std::filesystem::path& file) {
  if (!is_file(file)) return {.fault = "is missing"};
  return decode(map_file(file).view);
}

}  // namespace mh
