// SPDX-License-Identifier: Apache-2.0
#include "sim/render/edges.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

#include "sim/render/simd.hpp"

namespace mh {
namespace {

// A pixel is on an edge if its inverse depth deviates by this share from the mean of its two
// neighbors'. A plane deviates by 0, the corner of a box at 2 m by 1e-3: within an object, depth
// jumps are edges, but bends of its surface are not.
constexpr float kEdgeBend = 5e-3F;

/// Whether an edge runs through each of eight pixels, as bits.
unsigned edge_bits(const float* z, const InstanceId* id, std::ptrdiff_t width) {
  // Depths a, b, c are on a plane if 2/b = 1/a + 1/c.
  const Float8 middle = load8(z);
  const auto bent = [&](const float* before, const float* after) -> Int8 {
    const Float8 a = load8(before), c = load8(after);
    const Float8 across = 2.0F * a * c, through = middle * (a + c);
    return abs8(across - through) > kEdgeBend * through;
  };
  const auto load_ids = [](const InstanceId* from) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
  };
  const __m128i own = load_ids(id);
  const auto same = [&](const InstanceId* other) { return _mm_cmpeq_epi16(own, load_ids(other)); };
  const __m128i inside = _mm_and_si128(_mm_and_si128(same(id - 1), same(id + 1)),
                                       _mm_and_si128(same(id - width), same(id + width)));
  const Int8 other = ~(Int8)_mm256_cvtepi16_epi32(inside);
  const Int8 edge = other | bent(z - 1, z + 1) | bent(z - width, z + width);
  return static_cast<unsigned>(_mm256_movemask_ps((__m256)edge));
}

}  // namespace

void find_edges(const RenderedFrame& frame, int y0, std::vector<Pixel>& edges) {
  edges.clear();
  const int w = frame.depth_m.width(), h = frame.depth_m.height();
  if (w < 10) return;
  const int y1 = std::min(h - 1, y0 + kEdgeBlock);
  for (int x0 = 1; x0 < w - 1; x0 += kEdgeBlock)
    for (int y = std::max(1, y0); y < y1; ++y)
      for (int x = x0; x < std::min(w - 1, x0 + kEdgeBlock); x += 8) {
        // The last eight of a row would read past its end: they are shifted back, together with
        // their bits.
        const int from = std::max(1, std::min(x, w - 1 - 8));
        unsigned bits =
            edge_bits(&frame.depth_m(from, y), &frame.instances(from, y), w) >> (x - from);
        for (; bits != 0; bits &= bits - 1) edges.push_back({x + std::countr_zero(bits), y});
      }
}

}  // namespace mh
