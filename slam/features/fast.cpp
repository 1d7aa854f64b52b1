// SPDX-License-Identifier: Apache-2.0
#include "slam/features/fast.hpp"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>
#include <type_traits>

namespace mh {
namespace {

using Byte = std::uint8_t;
constexpr int kChunk = 32;  // pixels processed in parallel: one SIMD register

// A vector of bytes. The code below is written once for both a single byte and this vector.
struct Bytes {
  __m256i v;
};

template <class T>
T load(const Byte* from) {
  if constexpr (std::is_same_v<T, Byte>)
    return *from;
  else
    return {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from))};
}
void store(Byte* to, Byte value) {
  *to = value;
}
void store(Byte* to, Bytes value) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), value.v);
}
Byte low(Byte a, Byte b) {
  return a < b ? a : b;
}
Bytes low(Bytes a, Bytes b) {
  return {_mm256_min_epu8(a.v, b.v)};
}
Byte high(Byte a, Byte b) {
  return a > b ? a : b;
}
Bytes high(Bytes a, Bytes b) {
  return {_mm256_max_epu8(a.v, b.v)};
}
// a - b, 0 where b is larger.
Byte excess(Byte a, Byte b) {
  return static_cast<Byte>(high(a, b) - b);
}
Bytes excess(Bytes a, Bytes b) {
  return {_mm256_subs_epu8(a.v, b.v)};
}

// Calls work.operator()<T>(x) so that the calls cover [0, count). With T = Bytes, a call covers
// kChunk pixels, and the last chunk overlaps the one before. If there are fewer than kChunk pixels,
// T is Byte, and a call covers one pixel.
template <class Work>
void for_all(int count, Work work) {
  if (count < kChunk) {
    for (int x = 0; x < count; ++x) work.template operator()<Byte>(x);
    return;
  }
  for (int x = 0; x + kChunk < count; x += kChunk) work.template operator()<Bytes>(x);
  work.template operator()<Bytes>(count - kChunk);
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

struct Low {
  template <class T>
  static T of(T a, T b) {
    return low(a, b);
  }
};
struct High {
  template <class T>
  static T of(T a, T b) {
    return high(a, b);
  }
};

// The best arc of 9 contiguous pixels on the circle: the maximum, over all arcs, of the smallest
// value on the arc. Swapping Low and High (`Worse`, `Better`) gives the counterpart for darker
// arcs. Two arcs that start at k and k + 1 share 8 pixels, so the better of the two has the value
// min(shared, max(first, last)), where first and last are the pixels that they do not share.
template <class Worse, class Better, class T>
T best_arc(const std::array<T, 16>& p) {
  std::array<T, 8> pair, four;
  for (std::size_t i = 0; i < 8; ++i) pair[i] = Worse::of(p[2 * i + 1], p[(2 * i + 2) % 16]);
  for (std::size_t i = 0; i < 8; ++i) four[i] = Worse::of(pair[i], pair[(i + 1) % 8]);
  T best{};
  for (std::size_t i = 0; i < 8; ++i) {
    const T shared = Worse::of(four[i], four[(i + 2) % 8]);  // p[2 i + 1] to p[2 i + 8]
    const T arc = Worse::of(shared, Better::of(p[2 * i], p[(2 * i + 9) % 16]));
    best = i == 0 ? arc : Better::of(best, arc);
  }
  return best;
}

using Circle = std::array<const Byte*, 16>;

Circle circle_around(const Byte* center, std::ptrdiff_t step) {
  Circle circle;
  for (std::size_t i = 0; i < 16; ++i) circle[i] = center + kCircle[i].y * step + kCircle[i].x;
  return circle;
}

// Contrast: how much the best arc around each pixel is brighter or darker than the pixel; 0 = no
// such arc. Without branches, so that one pass serves every threshold.
template <class T>
T contrast(const Byte* center, const Circle& circle, int x) {
  std::array<T, 16> p;
  for (std::size_t i = 0; i < 16; ++i) p[i] = load<T>(circle[i] + x);
  const T c = load<T>(center + x);
  return high(excess(best_arc<Low, High>(p), c), excess(c, best_arc<High, Low>(p)));
}

// Three rows of contrast around the row being searched.
struct Rows {
  const Byte* above;
  const Byte* row;
  const Byte* below;
};

// Sets marks to nonzero values at local maxima above the threshold among `count` pixels; rows have
// one more pixel on either side.
void mark_maxima(const Rows& contrast, int count, Byte threshold, Byte* marks) {
  for_all(count, [&]<class T>(int x) {
    const Byte *above = contrast.above + x, *row = contrast.row + x, *below = contrast.below + x;
    const auto at = [](const Byte* p) { return load<T>(p); };
    const T sides = high(at(row - 1), at(row + 1));
    const T up = high(at(above), high(at(above - 1), at(above + 1)));
    const T down = high(at(below), high(at(below - 1), at(below + 1)));
    T limit;
    std::memset(&limit, threshold, sizeof limit);
    store(marks + x, excess(at(row), high(high(limit, sides), high(up, down))));
  });
}

// Position of the peak of the parabola through three values at -1, 0, 1, limited to less than half
// a pixel, so that the nearest pixel remains the same.
float peak(int before, int at, int after) {
  const int curvature = before - 2 * at + after;
  if (curvature >= 0) return 0.0F;
  return std::clamp(0.5F * static_cast<float>(before - after) / static_cast<float>(curvature),
                    -0.49F, 0.49F);
}

void collect(const std::vector<Byte>& marks, const Byte* contrast, int left, int y,
             std::vector<Corner>& corners) {
  for (std::size_t x = 0; x < marks.size(); x += kChunk) {
    const __m256i unmarked = _mm256_cmpeq_epi8(load<Bytes>(&marks[x]).v, _mm256_setzero_si256());
    for (auto left_over = ~static_cast<std::uint32_t>(_mm256_movemask_epi8(unmarked));
         left_over != 0; left_over &= left_over - 1) {
      const std::size_t i = x + static_cast<std::size_t>(std::countr_zero(left_over));
      corners.push_back({static_cast<std::int16_t>(left + static_cast<int>(i)),
                         static_cast<std::int16_t>(y), static_cast<std::int16_t>(contrast[i] - 1)});
    }
  }
}

}  // namespace

std::vector<Corner> fast_corners(const cv::Mat& image, int edge_px, int threshold) {
  assert(edge_px >= 4 && threshold >= 0 && threshold <= 255 && image.type() == CV_8U);
  const int width = image.cols - 2 * edge_px;
  const int height = image.rows - 2 * edge_px;
  if (width <= 0 || height <= 0) return {};

  // Contrast of three rows at a time, each with one pixel beyond the area on either side. Row y
  // is in buffer y % 3.
  const auto length = static_cast<std::size_t>(width + 2);
  std::array<std::vector<Byte>, 3> contrasts;
  for (std::vector<Byte>& row : contrasts) row.resize(length);
  const auto fill = [&](int y) {
    const Byte* center = image.ptr<Byte>(y) + edge_px - 1;
    const Circle circle = circle_around(center, static_cast<std::ptrdiff_t>(image.step));
    Byte* to = contrasts[static_cast<std::size_t>(y) % 3].data();
    for_all(width + 2, [&]<class T>(int x) { store(to + x, contrast<T>(center, circle, x)); });
  };
  const auto row = [&](int y) { return contrasts[static_cast<std::size_t>(y) % 3].data() + 1; };

  std::vector<Byte> marks(static_cast<std::size_t>((width + kChunk - 1) / kChunk * kChunk), 0);
  std::vector<Corner> corners;
  fill(edge_px - 1);
  fill(edge_px);
  for (int y = edge_px; y < edge_px + height; ++y) {
    fill(y + 1);
    const Rows rows{row(y - 1), row(y), row(y + 1)};
    mark_maxima(rows, width, static_cast<Byte>(threshold), marks.data());
    collect(marks, rows.row, edge_px, y, corners);
  }
  return corners;
}

cv::Point2f peak_of(const cv::Mat& image, const Corner& corner) {
  assert(corner.x >= kPeakReach_px && corner.x < image.cols - kPeakReach_px &&
         corner.y >= kPeakReach_px && corner.y < image.rows - kPeakReach_px);
  // Only the first 3 pixels of each chunk are used; beyond a row's end, a chunk contains pixels of
  // the next row.
  std::array<std::array<Byte, kChunk>, 3> near;
  for (int v = 0; v < 3; ++v) {
    const Byte* center = image.ptr<Byte>(corner.y + v - 1) + corner.x - 1;
    const Circle circle = circle_around(center, static_cast<std::ptrdiff_t>(image.step));
    store(near[static_cast<std::size_t>(v)].data(), contrast<Bytes>(center, circle, 0));
  }
  // Each parabola is fitted to sums over three pixels perpendicular to it, weighted 1 2 1, since
  // these are less noisy than single pixels.
  const auto column = [&](std::size_t u) { return near[0][u] + 2 * near[1][u] + near[2][u]; };
  const auto line = [&](std::size_t v) { return near[v][0] + 2 * near[v][1] + near[v][2]; };
  return {peak(column(0), column(1), column(2)), peak(line(0), line(1), line(2))};
}

}  // namespace mh
