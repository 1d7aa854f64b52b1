// SPDX-License-Identifier: Apache-2.0
#include "bench/lab/image_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace mh {
namespace {

constexpr int kWidth = 640, kHeight = 480;
constexpr int kFirstRing = 8, kLastRing = 159;  // cycles per 480 pixels

double corners(const cv::Mat& gray, int threshold) {
  std::vector<cv::KeyPoint> found;
  cv::FAST(gray, found, threshold, true);
  return static_cast<double>(found.size());
}

double keypoints(const cv::Mat& gray) {
  std::vector<cv::KeyPoint> found;
  cv::ORB::create(2000, 1.2F, 8, 31, 0, 2, cv::ORB::HARRIS_SCORE, 31, 20)->detect(gray, found);
  return static_cast<double>(found.size());
}

std::vector<double> values_of(const cv::Mat& floats) {
  std::vector<double> values;
  for (int y = 0; y < floats.rows; ++y)
    for (int x = 0; x < floats.cols; ++x)
      values.push_back(static_cast<double>(floats.at<float>(y, x)));
  return values;
}

double blank_share(const cv::Mat& gradient) {
  constexpr int kCellWidth = 40, kCellHeight = 30;
  constexpr double kBlank = 3.0;
  int blank = 0, cells = 0;
  for (int y = 0; y < kHeight; y += kCellHeight)
    for (int x = 0; x < kWidth; x += kCellWidth, ++cells)
      blank +=
          percentile(values_of(gradient(cv::Rect(x, y, kCellWidth, kCellHeight))), 0.95) < kBlank
              ? 1
              : 0;
  return static_cast<double>(blank) / cells;
}

double spectrum_slope(const cv::Mat& gray) {
  constexpr int n = kHeight;
  cv::Mat middle = gray(cv::Rect((kWidth - n) / 2, 0, n, n)).clone();
  middle -= cv::mean(middle)[0];
  std::vector<float> window(n);
  for (int i = 0; i < n; ++i)
    window[static_cast<std::size_t>(i)] =
        static_cast<float>(0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * i / (n - 1)));
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      middle.at<float>(y, x) *=
          window[static_cast<std::size_t>(y)] * window[static_cast<std::size_t>(x)];
  cv::Mat spectrum;
  cv::dft(middle, spectrum, cv::DFT_COMPLEX_OUTPUT);
  std::vector<double> power(n, 0.0);
  std::vector<int> count(n, 0);
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const double fy = y < n / 2 ? y : y - n, fx = x < n / 2 ? x : x - n;
      const auto ring = static_cast<std::size_t>(std::hypot(fx, fy));
      if (ring >= power.size()) continue;
      const cv::Vec2f c = spectrum.at<cv::Vec2f>(y, x);
      power[ring] += static_cast<double>(c[0]) * c[0] + static_cast<double>(c[1]) * c[1];
      ++count[ring];
    }
  // A line through (log frequency, log power) by least squares.
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  int m = 0;
  for (int k = kFirstRing; k <= kLastRing; ++k, ++m) {
    const auto ring = static_cast<std::size_t>(k);
    const double x = std::log(k);
    const double y = std::log(std::max(power[ring] / count[ring], 1e-12));
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (m * sxy - sx * sy) / (m * sxx - sx * sx);
}

}  // namespace

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double at = share * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(low);
  std::nth_element(values.begin(), middle, values.end());
  const double a = *middle;
  if (low + 1 >= values.size()) return a;
  return a + (at - static_cast<double>(low)) * (*std::min_element(middle + 1, values.end()) - a);
}

ImageStatistics measure_image(const Grid2d<Rgb8>& color) {
  // cv::Mat does not write through this view.
  const cv::Mat rgb(color.height(), color.width(), CV_8UC3, const_cast<Rgb8*>(color.data()));
  cv::Mat gray;
  cv::cvtColor(rgb, gray, cv::COLOR_RGB2GRAY);
  return measure_image(gray);
}

ImageStatistics measure_image(const cv::Mat& image) {
  cv::Mat gray = image;
  if (gray.cols != kWidth || gray.rows != kHeight)
    cv::resize(image, gray, {kWidth, kHeight}, 0, 0, cv::INTER_AREA);
  cv::Mat smooth, across, down, gradient, laplacian;
  gray.convertTo(smooth, CV_32F);
  cv::Sobel(smooth, across, CV_32F, 1, 0, 3, 1.0 / 8);
  cv::Sobel(smooth, down, CV_32F, 0, 1, 3, 1.0 / 8);
  cv::magnitude(across, down, gradient);
  cv::Laplacian(smooth, laplacian, CV_32F);
  cv::Scalar mean, deviation;
  cv::meanStdDev(laplacian, mean, deviation);
  const std::vector<double> gradients = values_of(gradient);
  return {corners(gray, 20),
          corners(gray, 7),
          keypoints(gray),
          percentile(gradients, 0.5),
          percentile(gradients, 0.95),
          blank_share(gradient),
          spectrum_slope(smooth),
          deviation[0] * deviation[0]};
}

std::string shown(double quantity) {
  return std::abs(quantity) >= 1000 ? fmt::format("{:.0f}", quantity)
                                    : fmt::format("{:.3g}", quantity);
}

}  // namespace mh
