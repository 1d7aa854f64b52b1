// SPDX-License-Identifier: Apache-2.0
#include "slam/features/refine.hpp"

#include <cmath>

namespace mh {
namespace {
constexpr int kRadius_px = 3;
// Determinant over squared trace of the structure tensor: below, the window holds an edge, not a corner.
constexpr double kMinRoundness = 0.02;
constexpr double kMaxShift_px = 1.0;
}  // namespace

cv::Point2d refine_corner(const cv::Mat& image, int x, int y) {
  double xx = 0, xy = 0, yy = 0, bx = 0, by = 0;
  for (int dy = -kRadius_px; dy <= kRadius_px; ++dy) {
    const auto* above = image.ptr<std::uint8_t>(y + dy - 1) + x;
    const auto* row = image.ptr<std::uint8_t>(y + dy) + x;
    const auto* below = image.ptr<std::uint8_t>(y + dy + 1) + x;
    for (int dx = -kRadius_px; dx <= kRadius_px; ++dx) {
      // Pixels far from the centre belong to other corners.
      const double weight = 1.0 / (1.0 + 0.25 * (dx * dx + dy * dy));
      const double gx = row[dx + 1] - row[dx - 1];
      const double gy = below[dx] - above[dx];
      const double wxx = weight * gx * gx, wxy = weight * gx * gy, wyy = weight * gy * gy;
      xx += wxx;
      xy += wxy;
      yy += wyy;
      bx += wxx * dx + wxy * dy;
      by += wxy * dx + wyy * dy;
    }
  }
  const double determinant = xx * yy - xy * xy;
  const double trace = xx + yy;
  if (!(determinant > kMinRoundness * trace * trace)) return cv::Point2d(x, y);
  const double shift_x = (yy * bx - xy * by) / determinant;
  const double shift_y = (xx * by - xy * bx) / determinant;
  if (std::abs(shift_x) > kMaxShift_px || std::abs(shift_y) > kMaxShift_px) return cv::Point2d(x, y);
  return {x + shift_x, y + shift_y};
}

}  // namespace mh
