// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/fit_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace mh {

Placement place_image(int width, int height, const InputSize& input, Letterbox letterbox) {
  Placement at;
  if (letterbox == Letterbox::kStretch) {
    at.width = input.width, at.height = input.height;
    at.scale_x = static_cast<double>(input.width) / width;
    at.scale_y = static_cast<double>(input.height) / height;
    return at;
  }
  const double scale = std::min(static_cast<double>(input.width) / width,
                                static_cast<double>(input.height) / height);
  at.scale_x = at.scale_y = scale;
  // Networks with kCorner truncate fractions of a pixel; those with kCenter round them.
  const bool corner = letterbox == Letterbox::kCorner;
  const auto size = [&](int of, int limit) {
    const double exact = of * scale;
    return std::clamp(static_cast<int>(corner ? exact : std::round(exact)), 1, limit);
  };
  at.width = size(width, input.width), at.height = size(height, input.height);
  if (!corner) {
    at.left = (input.width - at.width) / 2;
    at.top = (input.height - at.height) / 2;
  }
  return at;
}

cv::Mat network_input(const Grid2d<Rgb8>& color, const InputSize& input, const Placement& at,
                      const DetectorSettings& settings) {
  // cv::Mat does not write through this view.
  const cv::Mat rgb(color.height(), color.width(), CV_8UC3, const_cast<Rgb8*>(color.data()));
  cv::Mat canvas(input.height, input.width, CV_8UC3, cv::Scalar::all(settings.padding));
  cv::Mat scaled = canvas(cv::Rect(at.left, at.top, at.width, at.height));
  cv::resize(rgb, scaled, scaled.size(), 0, 0, cv::INTER_LINEAR);

  std::array<float, 3> mean{}, factor{1, 1, 1};  // of red, green, blue
  if (settings.normalize == Normalize::kUnit) factor.fill(1.0F / 255);
  if (settings.normalize == Normalize::kImagenet) {
    mean = {0.485F * 255, 0.456F * 255, 0.406F * 255};
    factor = {1 / (0.229F * 255), 1 / (0.224F * 255), 1 / (0.225F * 255)};
  }
  const std::array<int, 4> shape = {1, 3, input.height, input.width};
  cv::Mat blob(4, shape.data(), CV_32F);
  for (int plane = 0; plane < 3; ++plane) {
    const int from = settings.channels == Channels::kBgr ? 2 - plane : plane;
    const float m = mean[static_cast<std::size_t>(from)],
                f = factor[static_cast<std::size_t>(from)];
    auto* out = blob.ptr<float>(0, plane);
    for (int y = 0; y < input.height; ++y) {
      const auto* in = canvas.ptr<unsigned char>(y);
      for (int x = 0; x < input.width; ++x) *out++ = (static_cast<float>(in[3 * x + from]) - m) * f;
    }
  }
  return blob;
}

}  // namespace mh
