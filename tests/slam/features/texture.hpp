// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include <opencv2/imgproc.hpp>

#include "slam/core/camera.hpp"
#include "slam/core/random.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh::testing {

// Imitates a lens and a sensor: without them, neighboring pixels are equally good corners, and
// non-maximum suppression drops both.
inline void soften(cv::Mat& image) {
  cv::GaussianBlur(image, image, {5, 5}, 0.8);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) {
      const auto noise = RandomStream(77).below(static_cast<std::uint64_t>(y * image.cols + x), 3);
      auto& pixel = image.at<std::uint8_t>(y, x);
      pixel = static_cast<std::uint8_t>(std::min<int>(255, pixel + static_cast<int>(noise)));
    }
}

// Overlapping squares of random brightness: corners of every strength and size. Contrast decreases
// linearly from left (strong) to right (weak).
inline cv::Mat squares(int width, int height, std::uint64_t seed, double weakest = 0.2) {
  cv::Mat image(height, width, CV_8U, cv::Scalar(128));
  const RandomStream random(seed);
  for (std::uint64_t i = 0; i < 1500; ++i) {
    const RandomStream r = random.fork(i);
    const int x = static_cast<int>(r.below(0, static_cast<std::uint64_t>(width)));
    const int y = static_cast<int>(r.below(1, static_cast<std::uint64_t>(height)));
    const int size = 4 + static_cast<int>(r.below(2, 40));
    const double contrast = 1 - (1 - weakest) * x / width;
    const double gray = 128 + contrast * (r.uniform(3) * 250 - 125);
    cv::rectangle(image, {x, y, size, size}, cv::Scalar(gray), cv::FILLED);
  }
  soften(image);
  return image;
}

inline RgbdFrame frame_of(const cv::Mat& gray) {
  RgbdFrame frame;
  frame.color = Grid2d<Rgb8>(gray.cols, gray.rows);
  frame.depth_m = Grid2d<float>(gray.cols, gray.rows, 2.0F);
  for (int y = 0; y < gray.rows; ++y)
    for (int x = 0; x < gray.cols; ++x) {
      const auto g = gray.at<std::uint8_t>(y, x);
      frame.color(x, y) = {g, g, g};
    }
  return frame;
}

inline Camera camera_of(const RgbdFrame& frame) {
  Camera camera;
  camera.width_px = frame.color.width();
  camera.height_px = frame.color.height();
  camera.cx_px = (camera.width_px - 1) / 2.0;
  camera.cy_px = (camera.height_px - 1) / 2.0;
  return camera;
}

}  // namespace mh::testing
