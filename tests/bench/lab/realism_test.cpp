// SPDX-License-Identifier: Apache-2.0
#include "bench/lab/survey.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include <opencv2/imgproc.hpp>

#include "slam/core/random.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

enum : std::size_t { kFast20, kFast7, kOrb, kMedian, kHigh, kBlank, kSlope, kLaplacian };

TEST(Percentile, InterpolatesBetweenNeighbors) {
  EXPECT_DOUBLE_EQ(percentile({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(percentile({10, 20}, 0.25), 12.5);
  EXPECT_DOUBLE_EQ(percentile({7}, 0.95), 7);
  EXPECT_TRUE(std::isnan(percentile({}, 0.5)));
}

TEST(MeasureImage, OfABlankImageIsBlank) {
  const ImageStatistics s = measure_image(cv::Mat(480, 640, CV_8UC1, cv::Scalar(90)));
  EXPECT_EQ(s[kFast20], 0);
  EXPECT_EQ(s[kOrb], 0);
  EXPECT_EQ(s[kHigh], 0);
  EXPECT_EQ(s[kBlank], 1);
  EXPECT_EQ(s[kLaplacian], 0);
}

TEST(MeasureImage, OfARampHasItsGradient) {
  cv::Mat ramp(480, 640, CV_8UC1);
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x)
      ramp.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(x % 80 * 3);
  const ImageStatistics s = measure_image(ramp);
  EXPECT_DOUBLE_EQ(s[kMedian], 3.0);  // gray levels per pixel: Sobel / 8
  EXPECT_EQ(s[kFast20], 0);           // straight edges have no corners
}

TEST(MeasureImage, CountsCornersOfSquaresAndBlankCells) {
  cv::Mat squares(480, 640, CV_8UC1, cv::Scalar(60));
  for (int k = 0; k < 5; ++k)
    cv::rectangle(squares, cv::Rect(60 + 100 * k, 200, 40, 40), cv::Scalar(200), cv::FILLED);
  cv::GaussianBlur(squares, squares, {5, 5}, 1.0);  // leaves a single corner pixel at each corner
  const ImageStatistics s = measure_image(squares);
  EXPECT_EQ(s[kFast20], 20);
  EXPECT_EQ(s[kFast20], s[kFast7]);
  EXPECT_GT(s[kBlank], 0.85);
  EXPECT_LT(s[kBlank], 1.0);
}

/// Noise whose power falls with frequency^-3: amplitudes that fall with frequency^-1.5, and random
/// phases.
cv::Mat power_law_noise() {
  const RandomStream random(3);
  cv::Mat spectrum(480, 640, CV_32FC2);
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) {
      const double fy = (y < 240 ? y : y - 480) / 480.0, fx = (x < 320 ? x : x - 640) / 640.0;
      const double f = std::hypot(fx, fy), a = f > 0 ? std::pow(f, -1.5) : 0.0;
      const double p = 6.283185307 * random.uniform(static_cast<std::uint64_t>(640 * y + x));
      spectrum.at<cv::Vec2f>(y, x) = {static_cast<float>(a * std::cos(p)),
                                      static_cast<float>(a * std::sin(p))};
    }
  cv::Mat image, gray;
  cv::idft(spectrum, image, cv::DFT_REAL_OUTPUT | cv::DFT_SCALE);
  cv::normalize(image, gray, 0, 255, cv::NORM_MINMAX, CV_8U);
  return gray;
}

TEST(MeasureImage, OfNoiseWithAPowerLawHasItsSlope) {
  EXPECT_NEAR(measure_image(power_law_noise())[kSlope], -3.0, 0.1);
}

TEST(MeasureImage, TheSpectrumIsThatOfTheMiddleSquare) {
  cv::Mat gray = power_law_noise();
  const double slope = measure_image(gray)[kSlope];
  const auto paint = [&](int x, int width) {
    gray(cv::Rect(x, 0, width, 480)).setTo(0);
    return measure_image(gray)[kSlope];
  };
  EXPECT_EQ(paint(0, 80), slope);
  EXPECT_EQ(paint(560, 80), slope);
  EXPECT_NE(paint(80, 80), slope);
}

TEST(MeasureImage, ScalesToVgaFirst) {
  cv::Mat small(240, 320, CV_8UC1, cv::Scalar(60)), large;
  cv::rectangle(small, cv::Rect(100, 100, 40, 40), cv::Scalar(200), cv::FILLED);
  cv::resize(small, large, {1280, 960}, 0, 0, cv::INTER_NEAREST);
  cv::GaussianBlur(large, large, {9, 9}, 2.0);
  EXPECT_EQ(measure_image(large)[kFast20], 4);
}

TEST(RealFrames, OfTheDataFileAreThoseOfScanNet) {
  const auto real = load_real_frames(std::string(MH_SOURCE_DIR) + "/assets/real_frames.yaml");
  ASSERT_EQ(real.size(), 3U);
  EXPECT_EQ(real[0].name, "scannet");
  EXPECT_EQ(real[0].percentiles[kFast20][2], 220);
  EXPECT_EQ(real[0].percentiles[kSlope][0], -4.17);
}

TEST(Compare, TellsRangeSpreadAndWhoLeaves) {
  RealFrames real{.name = "r", .source = "s", .percentiles = {}};
  real.percentiles[0] = {0, 10, 20, 30, 40};
  std::vector<MeasuredPlace> places(3);
  for (std::size_t i = 0; i < 3; ++i) {
    places[i].name = std::to_string(i);
    ImageStatistics s{};
    s[0] = 15.0 + 20.0 * static_cast<double>(i);  // 15, 35, 55
    places[i].frames.assign(3, s);
  }
  const RealismRow row = compare(places, real, 0);
  EXPECT_EQ(row.median_of_places, 35);
  EXPECT_FALSE(row.in_range);
  EXPECT_EQ(row.outside, std::vector<std::size_t>{2});
  EXPECT_DOUBLE_EQ(row.spread_ratio, 1.0);
}

}  // namespace
}  // namespace mh
