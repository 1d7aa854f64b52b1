// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/images/png.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "slam/core/random.hpp"

#include "scenes/image_file.hpp"
#include "scenes/png_pixels.hpp"

namespace mh {
namespace {

/// Half noise, half a constant: literals and runs for the compression.
cv::Mat some_image(int width, int height, int type) {
  cv::Mat image(height, width, type);
  const RandomStream stream(5);
  const std::size_t row_bytes = static_cast<std::size_t>(width) * image.elemSize();
  for (int y = 0; y < height; ++y)
    for (std::size_t i = 0; i < row_bytes; ++i)
      image.ptr(y)[i] = static_cast<unsigned char>(
          y < height / 2 ? stream.below(static_cast<std::uint64_t>(y) * row_bytes + i, 256) : 7);
  return image;
}

class Png : public testing::TestWithParam<int> {};

TEST_P(Png, OpenCvReadsWhatIsWritten) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 2), cv::Size(637, 31)})
    for (const int level : {0, 1, 6, 9}) {
      const cv::Mat image = some_image(size.width, size.height, GetParam());
      const std::string file = encode_png(image, level);
      const std::vector<char> bytes(file.begin(), file.end());
      const cv::Mat read = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
      ASSERT_EQ(read.type(), image.type());
      ASSERT_EQ(read.size(), image.size());
      EXPECT_EQ(cv::norm(read, image, cv::NORM_INF), 0.0) << size << " level " << level;
      EXPECT_EQ(file, encode_png(image, level));
    }
}

TEST_P(Png, ImagesThatAreNoWholePieceOfMemory) {
  const cv::Mat whole = some_image(40, 30, GetParam()), part = whole(cv::Rect(3, 4, 21, 11));
  EXPECT_EQ(encode_png(part), encode_png(part.clone()));
}

/// The image as PNG, each row filtered by a given filter, or all in turn.
std::string filtered_png(const cv::Mat& image, int filter) {
  const std::vector<int> how = {cv::IMWRITE_PNG_COMPRESSION, 6, cv::IMWRITE_PNG_STRATEGY, filter};
  std::vector<unsigned char> bytes;
  cv::imencode(".png", image, bytes, how);
  return {bytes.begin(), bytes.end()};
}

// OpenCV is the plain way. Ramps make libpng choose among all five filters.
TEST_P(Png, PixelsAreThoseThatOpenCvReads) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 2), cv::Size(637, 31)}) {
    const cv::Mat noise = some_image(size.width, size.height, GetParam());
    cv::Mat ramp(size, GetParam());
    for (int y = 0; y < ramp.rows; ++y)
      for (std::size_t i = 0; i < static_cast<std::size_t>(ramp.cols) * ramp.elemSize(); ++i)
        ramp.ptr(y)[i] =
            static_cast<unsigned char>(y % 3 == 0   ? 3 * i
                                       : y % 3 == 1 ? 5 * static_cast<std::size_t>(y)
                                                    : i * i / 7 + static_cast<std::size_t>(y));
    for (const cv::Mat& image : {noise, ramp})
      for (const int strategy : {cv::IMWRITE_PNG_STRATEGY_DEFAULT,
                                 cv::IMWRITE_PNG_STRATEGY_FILTERED, cv::IMWRITE_PNG_STRATEGY_RLE}) {
        const std::string file = filtered_png(image, strategy);
        const cv::Mat read = decode_plain_png(file);
        ASSERT_EQ(read.type(), image.type());
        ASSERT_EQ(read.size(), image.size());
        EXPECT_EQ(cv::norm(read, image, cv::NORM_INF), 0.0) << size << " strategy " << strategy;
      }
  }
}

TEST_P(Png, DamagedPixelsAreLeftToOpenCv) {
  const std::string whole = encode_png(some_image(21, 13, GetParam()));
  for (std::size_t at = 8; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x41);
    decode_plain_png(damaged);  // the sanitizers watch
    decode_plain_png(whole.substr(0, at));
  }
  EXPECT_TRUE(decode_plain_png("not an image").empty());
  EXPECT_TRUE(decode_plain_png("").empty());
}

INSTANTIATE_TEST_SUITE_P(Types, Png, testing::Values(CV_8UC1, CV_8UC3, CV_16UC1));

TEST(PngText, IsFoundAgainAndLeavesTheImageAsItWas) {
  const cv::Mat image = some_image(40, 30, CV_8UC3);
  const std::string plain = encode_png(image), marked = with_text(plain, "made of", "a b");
  EXPECT_EQ(text_in(marked, "made of"), "a b");
  EXPECT_EQ(text_in(marked, "made"), "");
  EXPECT_EQ(text_in(plain, "made of"), "");
  EXPECT_EQ(text_in("no image", "made of"), "");
  EXPECT_EQ(image_fault(marked), nullptr);
  const std::vector<char> bytes(marked.begin(), marked.end());
  EXPECT_EQ(cv::norm(cv::imdecode(bytes, cv::IMREAD_UNCHANGED), image, cv::NORM_INF), 0.0);
  for (std::size_t size = 0; size < marked.size(); ++size)
    text_in(std::string_view(marked).substr(0, size), "made of");  // a truncated file does no harm
}

TEST(PngTypes, OthersAreLeftToOpenCv) {
  EXPECT_TRUE(is_png_type(CV_16UC1));
  EXPECT_FALSE(is_png_type(CV_32FC1));
  EXPECT_FALSE(is_png_type(CV_8UC4));
  const std::string with_opacity = filtered_png(some_image(9, 7, CV_8UC4), 0);
  EXPECT_TRUE(decode_plain_png(with_opacity).empty());
  EXPECT_EQ(decode_image(with_opacity).type(), CV_8UC4);
}

}  // namespace
}  // namespace mh
