// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/images/write_image.hpp"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "scenes/image_file.hpp"
#include "scenes/recordings/images/png.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {

cv::Mat color_image(const Grid2d<Rgb8>& color) {
  static_assert(sizeof(Rgb8) == 3);
  const cv::Mat rgb(color.height(), color.width(), CV_8UC3, const_cast<Rgb8*>(color.data()));
  cv::Mat image;
  cv::cvtColor(rgb, image, cv::COLOR_RGB2BGR);
  return image;
}

void write_image(const std::filesystem::path& file, const cv::Mat& image,
                 const std::vector<int>& settings) {
  if (file.extension() == ".png" && is_png_type(image.type()) && !image.empty()) {
    const bool level_given = settings.size() == 2 && settings[0] == cv::IMWRITE_PNG_COMPRESSION;
    write_atomically(file, level_given ? encode_png(image, settings[1]) : encode_png(image));
    return;
  }
  std::vector<unsigned char> bytes;
  if (!cv::haveImageWriter(file.string()) ||
      !cv::imencode(file.extension().string(), image, bytes, settings))
    throw InputError(
        fmt::format("{}: cannot be written: no image format has this extension", file.string()));
  write_atomically(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace mh
