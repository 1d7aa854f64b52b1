// SPDX-License-Identifier: Apache-2.0
#include "slam/features/resize.hpp"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace mh {
namespace {

using Byte = std::uint8_t;
constexpr int kOne = 256;         // weight of 1
constexpr int kGroup = 8;         // pixels processed in parallel
constexpr int kReach = 16;        // source pixels that a group is computed from
constexpr double kMaxStep = 1.8;  // so that a group's sources are within its reach

// Pixel `at` of the source and the next one, weighted kOne - next and next.
struct Tap {
  int at;
  int next;
};

// One tap per target pixel; beyond the outermost pixel centers of the source, only the outermost
// pixel counts.
std::vector<Tap> taps(int source_size, int target_size) {
  const double step = 1.0 / (static_cast<double>(target_size) / source_size);
  std::vector<Tap> result;
  for (int i = 0; i < target_size; ++i) {
    const double position = step * (i + 0.5) - 0.5;
    const int at = static_cast<int>(std::floor(position));
    if (at < 0)
      result.push_back({0, 0});
    else if (at >= source_size - 1)
      result.push_back({source_size - 1, 0});
    else
      result.push_back({at, static_cast<int>(std::nearbyint((position - at) * kOne))});
  }
  return result;
}

// How kGroup neighboring pixels of a target row are computed from kReach pixels of the source row.
struct Group {
  int source, target;              // first columns
  std::array<Byte, kReach> pairs;  // which bytes to pair: pixel and next, eight times
  std::array<std::int16_t, kReach> weights;
};

std::vector<Group> groups(int source_columns, int target_columns) {
  const std::vector<Tap> columns = taps(source_columns, target_columns);
  std::vector<Group> result;
  for (int x = 0; x < target_columns; x += kGroup) {
    Group group{};
    group.target = std::min(x, target_columns - kGroup);  // the last group overlaps the one before
    group.source =
        std::min(columns[static_cast<std::size_t>(group.target)].at, source_columns - kReach);
    for (int i = 0; i < kGroup; ++i) {
      const Tap tap = columns[static_cast<std::size_t>(group.target + i)];
      const int first = tap.at - group.source;
      assert(first >= 0 && first < kReach && (first + 1 < kReach || tap.next == 0));
      const auto k = static_cast<std::size_t>(2 * i);
      group.pairs[k] = static_cast<Byte>(first);
      group.pairs[k + 1] = static_cast<Byte>(std::min(first + 1, kReach - 1));
      group.weights[k] = static_cast<std::int16_t>(kOne - tap.next);
      group.weights[k + 1] = static_cast<std::int16_t>(tap.next);
    }
    result.push_back(group);
  }
  return result;
}

__m128i load16(const void* from) {
  return _mm_loadu_si128(static_cast<const __m128i*>(from));
}
__m256i load32(const void* from) {
  return _mm256_loadu_si256(static_cast<const __m256i*>(from));
}

// A source row at the target's columns, in 1/256 gray levels.
void resize_row(const Byte* from, const std::vector<Group>& columns, std::int32_t* to) {
  for (const Group& group : columns) {
    const __m128i pairs = _mm_shuffle_epi8(load16(from + group.source), load16(group.pairs.data()));
    const __m256i sums =
        _mm256_madd_epi16(_mm256_cvtepu8_epi16(pairs), load32(group.weights.data()));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + group.target), sums);
  }
}

// Interpolates between two rows from resize_row(), rounded: (upper (256 - next) + lower next) /
// 65536.
void blend_rows(const std::int32_t* upper, const std::int32_t* lower, int next, int columns,
                Byte* to) {
  const __m256i weight = _mm256_set1_epi32(next);
  const __m256i half = _mm256_set1_epi32(kOne * kOne / 2);
  const __m256i lowest_bytes =
      _mm256_set1_epi32(0x0c080400);  // gathers byte 0 of each of four numbers
  for (int x = 0;; x += kGroup) {
    x = std::min(x, columns - kGroup);
    const __m256i a = load32(upper + x), b = load32(lower + x);
    const __m256i sum = _mm256_add_epi32(_mm256_slli_epi32(a, 8),
                                         _mm256_mullo_epi32(_mm256_sub_epi32(b, a), weight));
    const __m256i rounded = _mm256_srli_epi32(_mm256_add_epi32(sum, half), 16);
    const __m256i four = _mm256_shuffle_epi8(rounded, lowest_bytes);
    const int first = _mm256_extract_epi32(four, 0), second = _mm256_extract_epi32(four, 4);
    std::memcpy(to + x, &first, 4);
    std::memcpy(to + x + 4, &second, 4);
    if (x + kGroup >= columns) break;
  }
}

}  // namespace

void resize_exactly(const cv::Mat& from, cv::Mat& to) {
  assert(from.type() == CV_8U && to.type() == CV_8U && !to.empty());
  if (from.cols < kReach || to.cols < kGroup || from.cols > kMaxStep * to.cols ||
      from.cols < to.cols) {
    cv::resize(from, to, to.size(), 0, 0, cv::INTER_LINEAR_EXACT);
    return;
  }
  const std::vector<Group> columns = groups(from.cols, to.cols);
  const std::vector<Tap> rows = taps(from.rows, to.rows);
  // The two source rows resized last; most source rows are used for two target rows.
  struct Row {
    int y = -1;
    std::vector<std::int32_t> values;
  };
  std::array<Row, 2> made;
  for (Row& row : made) row.values.resize(static_cast<std::size_t>(to.cols));
  const auto row = [&](int y) {
    Row& place = made[static_cast<std::size_t>(y) % 2];
    if (place.y != y) resize_row(from.ptr<Byte>(y), columns, place.values.data());
    place.y = y;
    return place.values.data();
  };
  for (int y = 0; y < to.rows; ++y) {
    const Tap tap = rows[static_cast<std::size_t>(y)];
    const std::int32_t* upper = row(tap.at);
    const std::int32_t* lower = tap.next == 0 ? upper : row(tap.at + 1);
    blend_rows(upper, lower, tap.next, to.cols, to.ptr<Byte>(y));
  }
}

}  // namespace mh
