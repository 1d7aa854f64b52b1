// SPDX-License-Identifier: Apache-2.0
#include "slam/features/pyramid.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "slam/features/blur.hpp"
#include "slam/features/resize.hpp"

namespace mh {
namespace {

void mirror_margin(cv::Mat& window) {
  cv::Mat whole = window;
  whole.adjustROI(kBlurRadius_px, kBlurRadius_px, kBlurRadius_px, kBlurRadius_px);
  cv::copyMakeBorder(window, whole, kBlurRadius_px, kBlurRadius_px, kBlurRadius_px, kBlurRadius_px,
                     cv::BORDER_REFLECT_101 | cv::BORDER_ISOLATED);
}

// A view of the frame's colors; OpenCV's type is not const, but nothing writes through it.
cv::Mat view(const Grid2d<Rgb8>& color) {
  static_assert(sizeof(Rgb8) == 3);
  return {color.height(), color.width(), CV_8UC3, const_cast<Rgb8*>(color.data())};
}

}  // namespace

std::vector<PyramidLevel> make_pyramid(const Grid2d<Rgb8>& color, const FeatureConfig& config,
                                       int min_size_px) {
  std::vector<PyramidLevel> levels;
  for (int l = 0; l < config.levels; ++l) {
    const double scale = std::pow(config.scale, l);
    const cv::Size size(cvRound(color.width() / scale), cvRound(color.height() / scale));
    if (std::min(size.width, size.height) < min_size_px) break;

    PyramidLevel level;
    level.scale_x = static_cast<double>(color.width()) / size.width;
    level.scale_y = static_cast<double>(color.height()) / size.height;
    level.image = image_to_blur(size);
    if (l == 0)
      cv::cvtColor(view(color), level.image, cv::COLOR_RGB2GRAY);
    else
      resize_exactly(levels.back().image, level.image);
    mirror_margin(level.image);
    level.blurred = blur_7x7(level.image);
    levels.push_back(std::move(level));
  }
  return levels;
}

}  // namespace mh
