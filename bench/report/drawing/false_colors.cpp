// SPDX-License-Identifier: Apache-2.0
#include "bench/report/drawing/false_colors.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>
#include <opencv2/imgproc.hpp>

namespace mh {
namespace {

// The part of Turbo that is used. The full scale runs from a nearly black blue to a dark red.
constexpr double kFarthest = 0.1, kNearest = 0.95;

constexpr std::uint8_t kNoReturn = 215;  // a gray, since Turbo has none; black already means void

// Colors by class. They were found by a search for the property that
// tests/bench/report/drawing/class_colors_test.cpp checks: for any two classes that touch in images
// of the model house, the four rooms or the 201 generated ones, the colors are at least 10 apart
// (CIEDE2000) for normal vision, protanopia, deuteranopia and tritanopia; any two classes are 20
// apart in L*a*b* (1976).
constexpr std::array<Rgb8, 55> kClassColors = {{
    {0, 0, 0},       {174, 199, 232}, {140, 170, 120}, {181, 163, 255}, {203, 119, 61},
    {0, 0, 188},     {140, 83, 73},   {255, 147, 174}, {235, 69, 47},   {89, 70, 26},
    {255, 45, 192},  {64, 16, 255},   {87, 213, 192},  {203, 91, 101},  {223, 164, 38},
    {5, 108, 107},   {218, 255, 200}, {115, 177, 255}, {200, 190, 4},   {28, 155, 131},
    {125, 22, 60},   {158, 247, 130}, {31, 56, 115},   {185, 255, 250}, {251, 133, 0},
    {73, 0, 119},    {67, 25, 59},    {113, 115, 82},  {98, 161, 164},  {237, 255, 137},
    {181, 139, 109}, {113, 199, 136}, {110, 35, 102},  {70, 211, 82},   {127, 80, 106},
    {0, 46, 26},     {198, 83, 159},  {175, 17, 94},   {125, 125, 255}, {142, 112, 174},
    {104, 70, 173},  {60, 60, 60},    {255, 53, 3},    {0, 150, 68},    {255, 178, 103},
    {252, 213, 107}, {111, 117, 148}, {255, 237, 198}, {209, 255, 94},  {151, 125, 128},
    {192, 213, 129}, {95, 124, 56},   {162, 116, 3},   {244, 179, 179}, {49, 18, 83},
}};

/// Colors nearness from far (0) to near (1), as 8-bit BGR.
cv::Mat colored(const cv::Mat& near_share) {
  cv::Mat gray, image;
  near_share.convertTo(gray, CV_8U, 255 * (kNearest - kFarthest), 255 * kFarthest);
  cv::applyColorMap(gray, image, cv::COLORMAP_TURBO);
  return image;
}

/// CIE L*a*b* (1976) of an sRGB color under D65.
Eigen::Vector3d lab(Rgb8 color) {
  const auto linear = [](std::uint8_t value) {
    const double v = value / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  const double r = linear(color.r), g = linear(color.g), b = linear(color.b);
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
  const double x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
  const double y = f(0.2126 * r + 0.7152 * g + 0.0722 * b);
  const double z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

}  // namespace

cv::Mat depth_colors(const Grid2d<float>& depth_m, float near_m, float far_m) {
  cv::Mat share(depth_m.height(), depth_m.width(), CV_32FC1);
  for (int y = 0; y < depth_m.height(); ++y)
    for (int x = 0; x < depth_m.width(); ++x)
      share.at<float>(y, x) = std::clamp((far_m - depth_m(x, y)) / (far_m - near_m), 0.0F, 1.0F);
  cv::Mat image = colored(share);
  for (int y = 0; y < depth_m.height(); ++y)
    for (int x = 0; x < depth_m.width(); ++x)
      if (depth_m(x, y) <= 0) image.at<cv::Vec3b>(y, x) = {kNoReturn, kNoReturn, kNoReturn};
  return image;
}

cv::Mat depth_scale() {
  cv::Mat ramp(1, 256, CV_32FC1);
  for (int i = 0; i < 256; ++i) ramp.at<float>(0, i) = 1.0F - static_cast<float>(i) / 255.0F;
  return colored(ramp);
}

Rgb8 class_color(ClassId id) {
  return kClassColors.at(id);
}

double color_distance(Rgb8 a, Rgb8 b) {
  return (lab(a) - lab(b)).norm();
}

}  // namespace mh
