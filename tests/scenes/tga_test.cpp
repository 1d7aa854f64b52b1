// SPDX-License-Identifier: Apache-2.0
#include "scenes/tga.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <string>

#include "scenes/image_file.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

/// A header of 2 x 2 pixels, followed by `rest`.
std::string tga(char kind, char bits, char descriptor, const std::string& rest, char colors = 0) {
  std::string bytes(18, '\0');
  bytes[1] = colors > 0 ? 1 : 0;
  bytes[2] = kind;
  bytes[5] = colors;
  bytes[7] = 24;
  bytes[12] = bytes[14] = 2;
  bytes[16] = bits;
  bytes[17] = descriptor;
  return bytes + rest;
}

const std::string kBlue("\xff\x00\x00", 3), kGreen("\x00\xff\x00", 3), kRed("\x00\x00\xff", 3),
    kGray("\x50\x50\x50", 3);

std::vector<cv::Vec3b> colors_of(const std::string& bytes) {
  const cv::Mat image = decode_image(bytes);
  EXPECT_EQ(image.type(), CV_8UC3);
  if (image.type() != CV_8UC3 || image.size() != cv::Size(2, 2)) return {};
  return {image.begin<cv::Vec3b>(), image.end<cv::Vec3b>()};
}

const std::vector<cv::Vec3b> kExpected = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {80, 80, 80}};

TEST(Tga, RowsBeginWhereItsHeaderSays) {
  EXPECT_EQ(colors_of(tga(2, 24, 0x20, kBlue + kGreen + kRed + kGray)), kExpected);
  EXPECT_EQ(colors_of(tga(2, 24, 0x00, kRed + kGray + kBlue + kGreen)), kExpected) << "at the foot";
  EXPECT_EQ(colors_of(tga(2, 24, 0x30, kGreen + kBlue + kGray + kRed)), kExpected)
      << "at the right";
}

TEST(Tga, RunsPalettesAndFewBitsAreTheSameColors) {
  // A run of one pixel, then three literal pixels.
  EXPECT_EQ(colors_of(tga(10, 24, 0x20, "\x80" + kBlue + "\x02" + kGreen + kRed + kGray)),
            kExpected);
  const cv::Mat one = decode_image(tga(10, 24, 0x20, "\x83" + kRed));
  EXPECT_EQ(cv::norm(one, cv::Mat(2, 2, CV_8UC3, cv::Scalar(0, 0, 255))), 0.0);
  const std::string places("\x00\x01\x02\x03", 4);
  EXPECT_EQ(colors_of(tga(1, 8, 0x20, kBlue + kGreen + kRed + kGray + places, 4)), kExpected);
  // Five bits each for red, green and blue.
  EXPECT_EQ(colors_of(tga(2, 16, 0x20, std::string("\x1f\x00\xe0\x03\x00\x7c\x4a\x29", 8))),
            (std::vector<cv::Vec3b>{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {82, 82, 82}}));
  const cv::Mat gray = decode_image(tga(3, 8, 0x20, std::string("\x01\x02\x03\x04", 4)));
  EXPECT_EQ(gray.type(), CV_8UC1);
  EXPECT_EQ(gray.at<std::uint8_t>(1, 0), 3);
}

TEST(Tga, FourthBytesAreOpacityOnlyIfItsHeaderSaysSo) {
  const std::string pixels(16, '\x07');
  EXPECT_EQ(decode_image(tga(2, 32, 0x28, pixels)).type(), CV_8UC4);
  EXPECT_EQ(decode_image(tga(2, 32, 0x20, pixels)).type(), CV_8UC3);
}

TEST(Tga, WhatIsNotWholeIsNone) {
  const std::string whole = tga(10, 24, 0x20, "\x83" + kRed);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_TRUE(decode_tga(whole.substr(0, size)).empty()) << size;
  EXPECT_TRUE(decode_tga(tga(2, 24, 0x20, kBlue + kGreen + kRed)).empty());
  EXPECT_TRUE(decode_tga(tga(1, 8, 0x20, kBlue + std::string(4, '\x01'), 1)).empty())
      << "beyond the palette";
  EXPECT_THROW(decode_image(tga(5, 24, 0x20, std::string(12, '\0'))), InputError);
}

}  // namespace
}  // namespace mh
