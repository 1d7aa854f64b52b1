// SPDX-License-Identifier: Apache-2.0
#include "slam/features/pyramid.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "slam/features/resize.hpp"

namespace mh {
namespace {

constexpr int kBlurRadius_px = 3;  // of the 7x7 kernel
constexpr double kBlurSigma_px = 2.0;

// Allocates an image as a window of a larger one, whose margin is meant to mirror the image's
// border. cv::GaussianBlur uses different arithmetic for windows and whole images; cv::ORB blurs
// windows, so this code does too.
cv::Mat windowed(cv::Size size) {
  cv::Mat whole(size.height + 2 * kBlurRadius_px, size.width + 2 * kBlurRadius_px, CV_8U);
  return whole(cv::Rect(kBlurRadius_px, kBlurRadius_px, size.width, size.height));
}

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
    level.image = windowed(size);
    if (l == 0)
      cv::cvtColor(view(color), level.image, cv::COLOR_RGB2GRAY);
    else
      resize_exactly(levels.back().image, level.image);
    mirror_margin(level.image);
    cv::GaussianBlur(level.image, level.blurred, {2 * kBlurRadius_px + 1, 2 * kBlurRadius_px + 1},
                     kBlurSigma_px, kBlurSigma_px, cv::BORDER_REFLECT_101);
    levels.push_back(std::move(level));
  }
  return levels;
}

}  // namespace mh
