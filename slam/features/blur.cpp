// SPDX-License-Identifier: Apache-2.0
#include "slam/features/blur.hpp"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "slam/core/grid2d.hpp"

namespace mh {
namespace {

using Byte = std::uint8_t;
constexpr int kBlock_px = 32;  // pixels of a row processed in parallel: one register of bytes

// The Gaussian in units of 1 / 256, as OpenCV rounds it. Their sum is 257, so that the sum of a row
// fits into 16 bits, and both passes together are exact in 32.
constexpr int kWeight[4] = {55, 49, 34, 18};  // by distance
constexpr int kSum = 257;

// Sums along one row at the pixels of a block; `low` holds pixels 0 to 7 and 16 to 23, `high` the
// others, which is the order in which registers are packed.
struct RowSums {
  __m256i low, high;
};

// A pair of weights for each two neighboring bytes.
__m256i byte_pairs(int first, int second) {
  return _mm256_set1_epi16(static_cast<std::int16_t>(first | second << 8));
}

RowSums sums_of_row(const Byte* from) {
  const __m256i outer = byte_pairs(kWeight[3], kWeight[2]),
                inner = byte_pairs(kWeight[1], kWeight[0]);
  const __m256i right = byte_pairs(kWeight[1], kWeight[2]), last = byte_pairs(kWeight[3], 0);
  const auto load = [&](int shift) {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from + shift));
  };
  const auto sum = [&](auto unpack) {
    const __m256i a = _mm256_maddubs_epi16(unpack(load(-3), load(-2)), outer);
    const __m256i b = _mm256_maddubs_epi16(unpack(load(-1), load(0)), inner);
    const __m256i c = _mm256_maddubs_epi16(unpack(load(1), load(2)), right);
    const __m256i d = _mm256_maddubs_epi16(unpack(load(3), load(3)), last);
    const __m256i all = _mm256_add_epi16(_mm256_add_epi16(a, b), _mm256_add_epi16(c, d));
    return _mm256_xor_si256(all, _mm256_set1_epi16(INT16_MIN));  // minus 2^15: fits a signed number
  };
  return {sum([](__m256i a, __m256i b) { return _mm256_unpacklo_epi8(a, b); }),
          sum([](__m256i a, __m256i b) { return _mm256_unpackhi_epi8(a, b); })};
}

// Sums of two successive rows side by side, for four quarters of a block.
using PairBlock = std::array<__m256i, 4>;
using RowPair = std::vector<PairBlock, LineAllocator<PairBlock>>;

void pair_rows(const Byte* upper, const Byte* lower, RowPair& to) {
  for (std::size_t block = 0; block < to.size(); ++block) {
    const RowSums a = sums_of_row(upper + kBlock_px * block);
    const RowSums b = sums_of_row(lower + kBlock_px * block);
    to[block] = {_mm256_unpacklo_epi16(a.low, b.low), _mm256_unpackhi_epi16(a.low, b.low),
                 _mm256_unpacklo_epi16(a.high, b.high), _mm256_unpackhi_epi16(a.high, b.high)};
  }
}

__m256i row_pairs(int upper, int lower) {
  return _mm256_set1_epi32(upper | lower << 16);
}

// Four pairs of rows, weighted and divided by 2^16, rounded to the nearest, halves to even.
__m256i weighted(const std::array<const PairBlock*, 4>& rows, const std::array<__m256i, 4>& weights,
                 std::size_t quarter) {
  __m256i sum = _mm256_set1_epi32((kSum << 15) + (1 << 15) - 1);  // the 2^15 that sums lack, half
  for (std::size_t i = 0; i < 4; ++i)
    sum = _mm256_add_epi32(sum, _mm256_madd_epi16((*rows[i])[quarter], weights[i]));
  const __m256i below = _mm256_sub_epi32(sum, _mm256_set1_epi32((1 << 15) - 1));
  const __m256i odd = _mm256_and_si256(_mm256_srli_epi32(below, 16), _mm256_set1_epi32(1));
  return _mm256_srli_epi32(_mm256_add_epi32(sum, odd), 16);
}

void write_block(const std::array<const PairBlock*, 4>& rows, const std::array<__m256i, 4>& weights,
                 Byte* to) {
  const __m256i low = _mm256_packus_epi32(weighted(rows, weights, 0), weighted(rows, weights, 1));
  const __m256i high = _mm256_packus_epi32(weighted(rows, weights, 2), weighted(rows, weights, 3));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_packus_epi16(low, high));
}

// OpenCV rounds halves up in the columns that are left over from its own registers of four.
void round_last_columns(const cv::Mat& image, int y, Byte* to) {
  for (int x = image.cols - image.cols % 4; x < image.cols; ++x) {
    int sum = 0;
    for (int v = -kBlurRadius_px; v <= kBlurRadius_px; ++v) {
      const Byte* row = image.ptr<Byte>() + (y + v) * static_cast<std::ptrdiff_t>(image.step) + x;
      int of_row = 0;
      for (int u = -kBlurRadius_px; u <= kBlurRadius_px; ++u)
        of_row += kWeight[std::abs(u)] * row[u];
      sum += kWeight[std::abs(v)] * of_row;
    }
    to[x] = static_cast<Byte>(std::min((sum + (1 << 15)) >> 16, 255));
  }
}

int whole_blocks(int columns) {
  return (columns + kBlock_px - 1) / kBlock_px * kBlock_px;
}

}  // namespace

cv::Mat image_to_blur(cv::Size size) {
  cv::Mat whole(size.height + 2 * kBlurRadius_px, whole_blocks(size.width) + 2 * kBlurRadius_px,
                CV_8U);
  return whole(cv::Rect(kBlurRadius_px, kBlurRadius_px, size.width, size.height));
}

cv::Mat blur_7x7(const cv::Mat& image) {
  assert(image.type() == CV_8U && image.isSubmatrix());
  const auto step = static_cast<std::ptrdiff_t>(image.step);
  const int columns = whole_blocks(image.cols);
  cv::Mat blurred(image.rows, columns, CV_8U);
  // Pair k holds the rows 2 k - 4 and 2 k - 3, in the place k % 5. The row above the margin has no
  // weight, nor has the one below it.
  std::array<RowPair, 5> pairs;
  for (RowPair& pair : pairs) pair.resize(static_cast<std::size_t>(columns / kBlock_px));
  const auto row = [&](int y) {
    return image.data + std::clamp(y, -kBlurRadius_px, image.rows + kBlurRadius_px - 1) * step;
  };
  const auto make = [&](int k) {
    pair_rows(row(2 * k - 4), row(2 * k - 3), pairs[static_cast<std::size_t>(k % 5)]);
  };
  const std::array<__m256i, 4> even = {row_pairs(0, kWeight[3]), row_pairs(kWeight[2], kWeight[1]),
                                       row_pairs(kWeight[0], kWeight[1]),
                                       row_pairs(kWeight[2], kWeight[3])};
  const std::array<__m256i, 4> odd = {row_pairs(kWeight[3], kWeight[2]),
                                      row_pairs(kWeight[1], kWeight[0]),
                                      row_pairs(kWeight[1], kWeight[2]), row_pairs(kWeight[3], 0)};
  for (int k = 0; k < 4; ++k) make(k);
  for (int m = 0; 2 * m < image.rows; ++m) {
    make(m + 4);
    for (std::size_t block = 0; block < pairs[0].size(); ++block) {
      const auto from = [&](int first) {
        std::array<const PairBlock*, 4> rows;
        for (int i = 0; i < 4; ++i)
          rows[static_cast<std::size_t>(i)] =
              &pairs[static_cast<std::size_t>((first + i) % 5)][block];
        return rows;
      };
      write_block(from(m), even, blurred.ptr<Byte>(2 * m) + kBlock_px * block);
      if (2 * m + 1 < image.rows)
        write_block(from(m + 1), odd, blurred.ptr<Byte>(2 * m + 1) + kBlock_px * block);
    }
  }
  for (int y = 0; y < image.rows; ++y) round_last_columns(image, y, blurred.ptr<Byte>(y));
  return blurred.colRange(0, image.cols);
}

}  // namespace mh
