// SPDX-License-Identifier: Apache-2.0
#include "slam/features/fast.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

namespace mh {
namespace {

using Byte = std::uint8_t;
constexpr int kChunk = 32;  // pixels judged side by side: one SIMD register

Byte low(Byte a, Byte b) {
  return a < b ? a : b;
}
Byte high(Byte a, Byte b) {
  return a > b ? a : b;
}

// The circle of radius 3, clockwise from the top.
struct Offset {
  int x, y;
};
constexpr std::array<Offset, 16> kCircle = {{{0, -3},
                                             {1, -3},
                                             {2, -2},
                                             {3, -1},
                                             {3, 0},
                                             {3, 1},
                                             {2, 2},
                                             {1, 3},
                                             {0, 3},
                                             {-1, 3},
                                             {-2, 2},
                                             {-3, 1},
                                             {-3, 0},
                                             {-3, -1},
                                             {-2, -2},
                                             {-1, -3}}};

// The best arc of 9 contiguous pixels on the circle: the largest over arcs of the smallest value on
// the arc. Swapping low and high (`worse`, `better`) gives the counterpart for darker arcs. Two
// arcs that start at k and k + 1 share 8 pixels: min(shared, max(first, last)) serves both.
template <Byte (*worse)(Byte, Byte), Byte (*better)(Byte, Byte)>
Byte best_arc(const std::array<Byte, 16>& p) {
  std::array<Byte, 8> pair, four;
  for (int i = 0; i < 8; ++i) pair[i] = worse(p[2 * i + 1], p[(2 * i + 2) % 16]);
  for (int i = 0; i < 8; ++i) four[i] = worse(pair[i], pair[(i + 1) % 8]);
  Byte best = 0;
  for (int i = 0; i < 8; ++i) {
    const Byte shared = worse(four[i], four[(i + 2) % 8]);  // p[2 i + 1] to p[2 i + 8]
    const Byte arc = worse(shared, better(p[2 * i], p[(2 * i + 9) % 16]));
    best = i == 0 ? arc : better(best, arc);
  }
  return best;
}

// By how much the best arc around each of `count` pixels is brighter or darker than the pixel; 0 =
// no such arc.
void contrast_of_row(const Byte* centre, std::ptrdiff_t step, int count, Byte* contrast) {
  std::array<const Byte*, 16> circle;
  for (std::size_t i = 0; i < 16; ++i) circle[i] = centre + kCircle[i].y * step + kCircle[i].x;
  for (int x = 0; x < count; ++x) {
    std::array<Byte, 16> p;
    for (std::size_t i = 0; i < 16; ++i) p[i] = circle[i][x];
    const Byte bright = best_arc<low, high>(p);
    const Byte dark = best_arc<high, low>(p);
    const Byte c = centre[x];
    const auto brighter = static_cast<Byte>(high(bright, c) - c);
    const auto darker = static_cast<Byte>(c - low(dark, c));
    contrast[x] = high(brighter, darker);
  }
}

// Three rows of contrast around a row under search.
struct Rows {
  const Byte* above;
  const Byte* row;
  const Byte* below;
};

// Marks local maxima above the threshold among `count` pixels; rows have one more on either side.
void mark_maxima(const Rows& contrast, int count, Byte threshold, Byte* marks) {
  const auto [above, row, below] = contrast;
  for (int x = 0; x < count; ++x) {
    const Byte sides = high(row[x - 1], row[x + 1]);
    const Byte up = high(above[x], high(above[x - 1], above[x + 1]));
    const Byte down = high(below[x], high(below[x - 1], below[x + 1]));
    const Byte beat = high(high(threshold, sides), high(up, down));
    marks[x] = row[x] > beat ? 1 : 0;
  }
}

// Where the parabola through three values at -1, 0, 1 peaks; less than half a pixel, so that the
// nearest pixel stays the same.
float peak(int before, int at, int after) {
  const int curvature = before - 2 * at + after;
  if (curvature >= 0) return 0.0F;
  return std::clamp(0.5F * static_cast<float>(before - after) / static_cast<float>(curvature),
                    -0.49F, 0.49F);
}

// The parabola runs through sums across, weighted 1 2 1: they carry less noise than one line.
Corner corner_at(const Rows& c, std::size_t i, int x, int y) {
  const auto column = [&](std::size_t k) { return c.above[k] + 2 * c.row[k] + c.below[k]; };
  const auto line = [&](const Byte* r) { return r[i - 1] + 2 * r[i] + r[i + 1]; };
  return {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y),
          static_cast<std::int16_t>(c.row[i] - 1), peak(column(i - 1), column(i), column(i + 1)),
          peak(line(c.above), line(c.row), line(c.below))};
}

void collect(const std::vector<Byte>& marks, const Rows& contrast, int left, int y,
             std::vector<Corner>& corners) {
  for (std::size_t x = 0; x < marks.size(); x += 8) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, &marks[x], 8);
    if (eight == 0) continue;
    for (std::size_t i = x; i < x + 8; ++i)
      if (marks[i]) corners.push_back(corner_at(contrast, i, left + static_cast<int>(i), y));
  }
}

}  // namespace

std::vector<Corner> fast_corners(const cv::Mat& image, int edge_px, int threshold) {
  assert(edge_px >= 4 && threshold >= 0 && threshold <= 255 && image.type() == CV_8U);
  const int width = image.cols - 2 * edge_px;
  const int height = image.rows - 2 * edge_px;
  if (width <= 0 || height <= 0) return {};

  // Contrast of three rows at a time, each with one pixel beyond the area on either side. Row y
  // lies in buffer y % 3.
  const auto length = static_cast<std::size_t>(width + 2);
  std::array<std::vector<Byte>, 3> contrast;
  for (std::vector<Byte>& row : contrast) row.resize(length);
  const auto fill = [&](int y) {
    contrast_of_row(image.ptr<Byte>(y) + edge_px - 1, static_cast<std::ptrdiff_t>(image.step),
                    width + 2, contrast[static_cast<std::size_t>(y) % 3].data());
  };
  const auto row = [&](int y) { return contrast[static_cast<std::size_t>(y) % 3].data() + 1; };

  std::vector<Byte> marks(static_cast<std::size_t>((width + kChunk - 1) / kChunk * kChunk), 0);
  std::vector<Corner> corners;
  fill(edge_px - 1);
  fill(edge_px);
  for (int y = edge_px; y < edge_px + height; ++y) {
    fill(y + 1);
    const Rows rows{row(y - 1), row(y), row(y + 1)};
    mark_maxima(rows, width, static_cast<Byte>(threshold), marks.data());
    collect(marks, rows, edge_px, y, corners);
  }
  return corners;
}

}  // namespace mh
