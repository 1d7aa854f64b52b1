// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/images/png.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdlib>
#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "slam/core/random.hpp"

#include "scenes/image_file.hpp"
#include "scenes/png_pixels.hpp"

namespace mh {
namespace {

/// Half noise, half a constant, so that compression uses both literals and runs.
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

/// A PNG whose rows are filtered by the five filters in turn, beginning with a given one.
std::string filtered_png(const cv::Mat& image, int first_filter) {
  const auto pixel = image.elemSize(), size = static_cast<std::size_t>(image.cols) * pixel;
  std::vector<unsigned char> above(size, 0), stream;
  for (int y = 0; y < image.rows; ++y) {
    std::vector<unsigned char> row(image.ptr(y), image.ptr(y) + size);
    for (std::size_t i = 0; i + 1 < size && image.depth() == CV_16U; i += 2)
      std::swap(row[i], row[i + 1]);
    for (std::size_t i = 0; i < size && pixel == 3; i += 3) std::swap(row[i], row[i + 2]);
    const int filter = (first_filter + y) % 5;
    stream.push_back(static_cast<unsigned char>(filter));
    for (std::size_t i = 0; i < size; ++i) {
      const int a = i < pixel ? 0 : row[i - pixel], b = above[i],
                c = i < pixel ? 0 : above[i - pixel];
      const int p = a + b - c, pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
      const int paeth = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
      const int predicted[] = {0, a, b, (a + b) / 2, paeth};
      stream.push_back(static_cast<unsigned char>(row[i] - predicted[filter]));
    }
    above = row;
  }
  uLongf bytes = compressBound(stream.size());
  std::string data(bytes, '\0');
  compress(reinterpret_cast<Bytef*>(data.data()), &bytes, stream.data(), stream.size());
  data.resize(bytes);
  std::string file = "\x89PNG\r\n\x1a\n";
  const auto put = [](std::string& to, std::size_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) to += static_cast<char>(value >> shift & 255);
  };
  const auto chunk = [&](const std::string& type, const std::string& content) {
    put(file, content.size());
    file += type + content;
    const std::string typed = type + content;
    put(file,
        crc32(0, reinterpret_cast<const Bytef*>(typed.data()), static_cast<uInt>(typed.size())));
  };
  std::string header;
  put(header, static_cast<std::size_t>(image.cols));
  put(header, static_cast<std::size_t>(image.rows));
  header += image.depth() == CV_16U ? '\x10' : '\x08';
  header += image.channels() == 3 ? '\x02' : '\0';
  header += std::string(3, '\0');
  chunk("IHDR", header);
  chunk("IDAT", data.substr(0, data.size() / 2));  // decoders join them
  chunk("IDAT", data.substr(data.size() / 2));
  chunk("IEND", "");
  return file;
}

TEST_P(Png, PixelsAreThoseThatOpenCvReads) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 2), cv::Size(637, 31)}) {
    const cv::Mat image = some_image(size.width, size.height, GetParam());
    for (int filter = 0; filter < 5; ++filter) {
      const std::string file = filtered_png(image, filter);
      const std::vector<char> bytes(file.begin(), file.end());
      EXPECT_EQ(cv::norm(cv::imdecode(bytes, cv::IMREAD_UNCHANGED), image, cv::NORM_INF), 0.0);
      const cv::Mat read = decode_plain_png(file);
      ASSERT_EQ(read.type(), image.type());
      ASSERT_EQ(read.size(), image.size());
      EXPECT_EQ(cv::norm(read, image, cv::NORM_INF), 0.0) << size << " from filter " << filter;
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
  std::string huge = whole;
  huge[17] = huge[21] = '\x0f';  // a million pixels wide and high, of which nothing is allocated
  EXPECT_TRUE(decode_plain_png(huge).empty());
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
  std::vector<unsigned char> bytes;
  cv::imencode(".png", some_image(9, 7, CV_8UC4), bytes);
  const std::string with_opacity(bytes.begin(), bytes.end());
  EXPECT_TRUE(decode_plain_png(with_opacity).empty());
  EXPECT_EQ(decode_image(with_opacity).type(), CV_8UC4);
}

}  // namespace
}  // namespace mh
