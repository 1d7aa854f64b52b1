// SPDX-License-Identifier: Apache-2.0
#include "sim/render/agreement.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

namespace mh {
namespace {

constexpr float kTieShare = 1e-5F;
constexpr int kColorLevels = 2;
constexpr float kJumpM = 0.02F, kJumpShare = 0.02F;

bool same_color(Rgb8 a, Rgb8 b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)}) <= kColorLevels;
}

bool silhouette(const RenderedFrame& frame, int x, int y) {
  const float depth = frame.depth_m(x, y);
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      if (!frame.depth_m.contains(x + dx, y + dy)) continue;
      const float jump = std::abs(frame.depth_m(x + dx, y + dy) - depth);
      if (frame.instances(x + dx, y + dy) != frame.instances(x, y)) return true;
      if (jump > kJumpM && jump > kJumpShare * depth) return true;
    }
  return false;
}

}  // namespace

double Agreement::depth_rmse_m() const {
  return std::sqrt(square_depth_m2 / static_cast<double>(smooth));
}

void Agreement::add(const RenderedFrame& a, const RenderedFrame& b) {
  assert(a.depth_m.width() == b.depth_m.width() && a.depth_m.height() == b.depth_m.height());
  for (int y = 0; y < a.depth_m.height(); ++y)
    for (int x = 0; x < a.depth_m.width(); ++x) {
      ++pixels;
      same_class += a.classes(x, y) == b.classes(x, y);
      same_instance += a.instances(x, y) == b.instances(x, y);
      ties += a.instances(x, y) != b.instances(x, y) &&
              std::abs(a.depth_m(x, y) - b.depth_m(x, y)) <= kTieShare * a.depth_m(x, y);
      same_color += mh::same_color(a.color(x, y), b.color(x, y));
      if (silhouette(a, x, y) || silhouette(b, x, y)) continue;
      ++smooth;
      const double d = static_cast<double>(a.depth_m(x, y)) - b.depth_m(x, y);
      square_depth_m2 += d * d;
    }
}

}  // namespace mh
