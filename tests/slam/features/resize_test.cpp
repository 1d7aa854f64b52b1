// SPDX-License-Identifier: Apache-2.0
#include "slam/features/resize.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "slam/core/random.hpp"

namespace mh {
namespace {

cv::Mat noise(cv::Size size) {
  const RandomStream random(7);
  cv::Mat image(size, CV_8U);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      image.at<std::uint8_t>(y, x) =
          static_cast<std::uint8_t>(random.below(static_cast<std::uint64_t>(y * 4096 + x), 256));
  return image;
}

class ResizeExactly : public ::testing::TestWithParam<std::pair<cv::Size, cv::Size>> {};

TEST_P(ResizeExactly, GivesTheBitsOfOpenCv) {
  const auto [source_size, target_size] = GetParam();
  const cv::Mat source = noise(source_size);
  cv::Mat expected;
  cv::resize(source, expected, target_size, 0, 0, cv::INTER_LINEAR_EXACT);

  // The target is a window: the pixels around it must not change.
  cv::Mat whole(target_size.height + 2, target_size.width + 40, CV_8U, cv::Scalar(77));
  cv::Mat window = whole(cv::Rect({20, 1}, target_size));
  resize_exactly(source, window);
  EXPECT_EQ(cv::norm(window, expected, cv::NORM_INF), 0);
  window.setTo(77);
  EXPECT_EQ(cv::countNonZero(whole != 77), 0);
}

// Levels of the usual pyramid, odd sizes, a hardly smaller image, an equal one, the widest step, a
// wider one (done by OpenCV), a larger image, and the smallest one that is handled here.
INSTANTIATE_TEST_SUITE_P(Sizes, ResizeExactly,
                         ::testing::Values(std::pair{cv::Size(640, 480), cv::Size(533, 400)},
                                           std::pair{cv::Size(533, 400), cv::Size(444, 333)},
                                           std::pair{cv::Size(215, 161), cv::Size(179, 134)},
                                           std::pair{cv::Size(641, 37), cv::Size(640, 37)},
                                           std::pair{cv::Size(100, 90), cv::Size(100, 90)},
                                           std::pair{cv::Size(180, 90), cv::Size(100, 40)},
                                           std::pair{cv::Size(200, 90), cv::Size(100, 40)},
                                           std::pair{cv::Size(50, 40), cv::Size(61, 60)},
                                           std::pair{cv::Size(16, 5), cv::Size(9, 4)}));

}  // namespace
}  // namespace mh
