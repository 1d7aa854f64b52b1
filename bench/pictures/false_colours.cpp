// SPDX-License-Identifier: Apache-2.0
#include "bench/pictures/false_colours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Core>
#include <opencv2/imgproc.hpp>

namespace mh {
namespace {

// Parts of Turbo, which runs from a nearly black blue to a dark red.
constexpr double kFarthest = 0.1, kNearest = 0.95;

// Far enough apart to be told in a legend; with 55 classes little more can be had of all of them.
constexpr double kApart = 22;
constexpr int kStep = 24;  // of the colours to choose from

/// Shares of the way from far (0) to near (1), as 8-bit BGR.
cv::Mat coloured(const cv::Mat& near_share) {
  cv::Mat grey, picture;
  near_share.convertTo(grey, CV_8U, 255 * (kNearest - kFarthest), 255 * kFarthest);
  cv::applyColorMap(grey, picture, cv::COLORMAP_TURBO);
  return picture;
}

/// CIE L*a*b* (1976) of an sRGB colour under D65.
Eigen::Vector3d lab(Rgb8 colour) {
  const auto linear = [](std::uint8_t value) {
    const double v = value / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  const double r = linear(colour.r), g = linear(colour.g), b = linear(colour.b);
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
  const double x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
  const double y = f(0.2126 * r + 0.7152 * g + 0.0722 * b);
  const double z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

struct Chosen {
  Rgb8 colour;
  Eigen::Vector3d lab;
};

double to_nearest(const Eigen::Vector3d& lab, const std::vector<Chosen>& chosen) {
  double nearest = std::numeric_limits<double>::max();
  for (const Chosen& other : chosen) nearest = std::min(nearest, (other.lab - lab).norm());
  return nearest;
}

std::vector<Chosen> choose_colours() {
  std::vector<Chosen> grid, chosen;
  for (int r = 15; r < 256; r += kStep)
    for (int g = 15; g < 256; g += kStep)
      for (int b = 15; b < 256; b += kStep) {
        const Rgb8 colour{static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(g),
                          static_cast<std::uint8_t>(b)};
        grid.push_back({colour, lab(colour)});
      }
  for (const ClassInfo& info : classes()) {
    const Rgb8 own{info.r, info.g, info.b};
    Chosen best{own, lab(own)};
    const Eigen::Vector3d wanted = best.lab;
    if (to_nearest(wanted, chosen) < kApart) {
      double least = std::numeric_limits<double>::max();
      for (const Chosen& candidate : grid) {
        const double away = (candidate.lab - wanted).norm();
        if (away >= least || to_nearest(candidate.lab, chosen) < kApart) continue;
        least = away;
        best = candidate;
      }
    }
    chosen.push_back(best);
  }
  return chosen;
}

}  // namespace

cv::Mat depth_colours(const Grid2d<float>& depth_m, float near_m, float far_m) {
  cv::Mat share(depth_m.height(), depth_m.width(), CV_32FC1);
  for (int y = 0; y < depth_m.height(); ++y)
    for (int x = 0; x < depth_m.width(); ++x)
      share.at<float>(y, x) =
          std::clamp((far_m - depth_m(x, y)) / (far_m - near_m), 0.0F, 1.0F);
  cv::Mat picture = coloured(share);
  for (int y = 0; y < depth_m.height(); ++y)
    for (int x = 0; x < depth_m.width(); ++x)
      if (depth_m(x, y) <= 0) picture.at<cv::Vec3b>(y, x) = {0, 0, 0};
  return picture;
}

cv::Mat depth_scale() {
  cv::Mat ramp(1, 256, CV_32FC1);
  for (int i = 0; i < 256; ++i) ramp.at<float>(0, i) = 1.0F - static_cast<float>(i) / 255.0F;
  return coloured(ramp);
}

Rgb8 class_colour(ClassId id) {
  static const std::vector<Chosen> kColours = choose_colours();
  return kColours[id].colour;
}

double colour_distance(Rgb8 a, Rgb8 b) {
  return (lab(a) - lab(b)).norm();
}

}  // namespace mh
