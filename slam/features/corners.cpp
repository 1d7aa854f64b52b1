// SPDX-License-Identifier: Apache-2.0
#include "slam/features/corners.hpp"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>

namespace mh {
namespace {

constexpr int kCell_px = 36;

// The search area, divided into cells of about kCell_px.
struct Cells {
  cv::Rect area;
  int columns, rows;

  explicit Cells(const cv::Rect& a)
      : area(a),
        columns(std::max(1, cvRound(static_cast<double>(a.width) / kCell_px))),
        rows(std::max(1, cvRound(static_cast<double>(a.height) / kCell_px))) {
    for (int x = 0; x < a.width; ++x) column_of.push_back(x * columns / a.width);
    for (int y = 0; y < a.height; ++y) first_of_row.push_back(y * rows / a.height * columns);
  }

  std::size_t count() const { return static_cast<std::size_t>(columns) * rows; }
  std::size_t of(const Corner& c) const {
    return static_cast<std::size_t>(first_of_row[static_cast<std::size_t>(c.y - area.y)] +
                                    column_of[static_cast<std::size_t>(c.x - area.x)]);
  }

 private:
  // One division for each coordinate instead of two for each corner.
  std::vector<int> column_of, first_of_row;
};

// Sorts corners from row-major order to that of `stronger`, by a counting sort, which is stable.
std::vector<Corner> strongest_first(const std::vector<Corner>& corners) {
  std::array<std::size_t, 257> start{};
  for (const Corner& c : corners) ++start[static_cast<std::size_t>(256 - c.strength)];
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  std::vector<Corner> sorted(corners.size());
  for (const Corner& c : corners) sorted[start[static_cast<std::size_t>(255 - c.strength)]++] = c;
  return sorted;
}

// Picks at most `count` corners that are at least `spacing` apart, strongest first.
class SpacedPicker {
 public:
  explicit SpacedPicker(const std::vector<Corner>& corners) : corners_(corners) {
    for (const Corner& c : corners) {
      width_ = std::max(width_, c.x + 1);
      height_ = std::max(height_, c.y + 1);
    }
  }

  std::vector<Corner> pick(int spacing, std::size_t count) {
    // Cells as large as the spacing contain at most one picked corner. A rim of empty cells avoids
    // bounds checks. Four cells more are allocated, since a load at the last cell reads past it;
    // they are not compared.
    const int columns = width_ / spacing + 3;
    const int rows = height_ / spacing + 3;
    taken_.assign(static_cast<std::size_t>(columns) * rows + 4, kNone);
    const std::vector<int> cell_of = cells_of_coordinates(spacing);
    std::vector<Corner> picked;
    picked.reserve(count);
    for (const Corner& c : corners_) {
      Place* cell =
          &taken_[static_cast<std::size_t>(cell_of[static_cast<std::size_t>(c.y)]) * columns +
                  cell_of[static_cast<std::size_t>(c.x)]];
      if (!is_free({c.x, c.y}, cell, columns, spacing)) continue;
      *cell = {c.x, c.y};
      picked.push_back(c);
      if (picked.size() == count) break;
    }
    return picked;
  }

  // An upper bound: no larger spacing can yield `count` corners.
  int largest_spacing(std::size_t count) const {
    int spacing = 1;
    while (static_cast<std::size_t>((width_ / (spacing + 1) + 1)) * (height_ / (spacing + 1) + 1) >=
               count &&
           spacing < std::max(width_, height_))
      ++spacing;
    return spacing;
  }

 private:
  struct Place {
    std::int16_t x, y;
  };
  static constexpr Place kNone{-20000, -20000};  // farther from any corner than the largest spacing

  // 1 + i / spacing for all coordinates i: one division per coordinate instead of per corner.
  std::vector<int> cells_of_coordinates(int spacing) const {
    std::vector<int> cells(static_cast<std::size_t>(std::max(width_, height_)));
    for (std::size_t i = 0, cell = 1, next = 0; i < cells.size(); ++i) {
      if (next == static_cast<std::size_t>(spacing)) {
        ++cell;
        next = 0;
      }
      ++next;
      cells[i] = static_cast<int>(cell);
    }
    return cells;
  }

  // Compares a place with the corners picked in its own cell and the eight around it. Each load
  // takes the three cells of a row, and one more.
  static bool is_free(Place c, const Place* cell, int columns, int spacing) {
    const __m128i here = _mm_set1_epi32(std::bit_cast<std::int32_t>(c));
    const __m128i limit = _mm_set1_epi16(static_cast<std::int16_t>(spacing));
    __m128i near = _mm_setzero_si128();
    for (int row = -1; row <= 1; ++row) {
      const auto* from = reinterpret_cast<const __m128i*>(cell + row * columns - 1);
      const __m128i distance = _mm_abs_epi16(_mm_sub_epi16(_mm_loadu_si128(from), here));
      const __m128i below = _mm_cmpgt_epi16(limit, distance);
      near = _mm_or_si128(near, _mm_cmpeq_epi32(below, _mm_set1_epi32(-1)));
    }
    return (_mm_movemask_ps(_mm_castsi128_ps(near)) & 7) == 0;
  }

  const std::vector<Corner>& corners_;
  int width_ = 1, height_ = 1;
  std::vector<Place> taken_;
};

}  // namespace

std::vector<Corner> find_corners(const cv::Mat& image, int edge_px, int threshold,
                                 int low_threshold) {
  std::vector<Corner> corners = fast_corners(image, edge_px, std::min(threshold, low_threshold));
  if (corners.empty()) return corners;

  const Cells cells({edge_px, edge_px, image.cols - 2 * edge_px, image.rows - 2 * edge_px});
  std::vector<char> has_strong(cells.count(), 0);
  for (const Corner& c : corners)
    if (c.strength >= threshold) has_strong[cells.of(c)] = 1;
  std::erase_if(corners, [&](const Corner& c) {
    return c.strength < (has_strong[cells.of(c)] ? threshold : low_threshold);
  });
  return strongest_first(corners);
}

std::vector<Corner> spread(const std::vector<Corner>& corners, int count) {
  assert(std::is_sorted(corners.begin(), corners.end(), stronger));
  const auto wanted = static_cast<std::size_t>(std::max(count, 0));
  if (corners.size() <= wanted) return corners;
  if (wanted == 0) return {};

  SpacedPicker picker(corners);
  int good = 1;  // at spacing 1 nothing is rejected
  int bad = picker.largest_spacing(wanted) + 1;
  while (bad - good > 1) {
    const int spacing = good + (bad - good) / 2;
    (picker.pick(spacing, wanted).size() < wanted ? bad : good) = spacing;
  }
  return picker.pick((good + 1) / 2, wanted);
}

std::vector<int> share_out(int total, double ratio, const std::vector<int>& available) {
  const auto levels = available.size();
  double sum = 0;
  for (std::size_t l = 0; l < levels; ++l) sum += std::pow(ratio, static_cast<double>(l));

  std::vector<int> share(levels);
  int left = total;
  for (std::size_t l = levels; l-- > 0;) {  // the finest level gets the rounding remainder
    const int quota =
        l == 0
            ? left
            : static_cast<int>(std::lround(total / sum * std::pow(ratio, static_cast<double>(l))));
    left -= quota;
    share[l] = quota;
  }
  int unused = 0;
  for (std::size_t l = 0; l < levels; ++l) {
    unused += std::max(0, share[l] - available[l]);
    share[l] = std::min(share[l], available[l]);
  }
  for (std::size_t l = 0; l < levels; ++l) {
    const int more = std::min(unused, available[l] - share[l]);
    share[l] += more;
    unused -= more;
  }
  return share;
}

}  // namespace mh
