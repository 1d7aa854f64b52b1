// SPDX-License-Identifier: Apache-2.0
#include "slam/features/blur.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "slam/core/random.hpp"

namespace mh {
namespace {

/// The image in a window with a mirrored margin, as the pyramid makes it.
cv::Mat windowed(const cv::Mat& image) {
  cv::Mat window = image_to_blur(image.size());
  image.copyTo(window);
  cv::Mat whole = window;
  constexpr int kMargin = kBlurRadius_px;
  whole.adjustROI(kMargin, kMargin, kMargin, kMargin);
  cv::copyMakeBorder(window, whole, kMargin, kMargin, kMargin, kMargin,
                     cv::BORDER_REFLECT_101 | cv::BORDER_ISOLATED);
  return window;
}

int different_pixels(const cv::Mat& image) {
  const cv::Mat window = windowed(image);
  cv::Mat expected;
  cv::GaussianBlur(window, expected, {7, 7}, 2, 2, cv::BORDER_REFLECT_101);
  return cv::countNonZero(blur_7x7(window) != expected);
}

TEST(Blur, HasTheBitsOfOpenCv) {
  const RandomStream random(1);
  std::uint64_t draw = 0;
  for (const cv::Size size : {cv::Size(640, 480),
                              {533, 400},
                              {370, 277},
                              {179, 134},
                              {66, 39},
                              {39, 41},
                              {32, 8},
                              {31, 9},
                              {7, 7}}) {
    cv::Mat noise(size, CV_8U), contrast(size, CV_8U), ramp(size, CV_8U);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        noise.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(random.below(draw++, 256));
        contrast.at<std::uint8_t>(y, x) = random.below(draw++, 2) == 0 ? 0 : 255;
        ramp.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(x + 2 * y);
      }
    for (const cv::Mat& image : {noise, contrast, ramp, cv::Mat(size, CV_8U, cv::Scalar(255)),
                                 cv::Mat(size, CV_8U, cv::Scalar(0))})
      EXPECT_EQ(different_pixels(image), 0) << size;
  }
}

// Sums that end at exactly one half are rare in noise: one bright pixel has one for each weight of
// 2^15 / (a b), found by trying all brightnesses on all backgrounds.
TEST(Blur, RoundsHalvesAsOpenCvDoes) {
  for (int background = 0; background < 256; background += 5)
    for (int bright = 0; bright < 256; bright += 3) {
      cv::Mat image(12, 39, CV_8U, cv::Scalar(background));  // 3 columns beyond OpenCV's registers
      image.at<std::uint8_t>(6, 20) = image.at<std::uint8_t>(6, 37) =
          static_cast<std::uint8_t>(bright);
      ASSERT_EQ(different_pixels(image), 0) << background << " " << bright;
    }
}

}  // namespace
}  // namespace mh
