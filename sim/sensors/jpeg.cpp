// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/jpeg.hpp"

#include <algorithm>
#include <vector>

#include <opencv2/imgcodecs.hpp>

namespace mh {

void compress(Grid2d<Rgb8>& color, int quality) {
  // OpenCV takes the channels as blue, green, red: both ways are exchanged alike.
  Grid2d<Rgb8> exchanged = color;
  const auto exchange = [](Grid2d<Rgb8>& image) {
    for (std::size_t i = 0; i < image.size(); ++i) std::swap(image.data()[i].r, image.data()[i].b);
  };
  exchange(exchanged);
  const cv::Mat whole(color.height(), color.width(), CV_8UC3, exchanged.data());
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", whole, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  const cv::Mat read = cv::imdecode(bytes, cv::IMREAD_COLOR);
  std::copy_n(read.ptr<unsigned char>(), 3 * color.size(),
              reinterpret_cast<unsigned char*>(color.data()));
  exchange(color);
}

}  // namespace mh
