// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace mh {

/// A corner on one pyramid level.
struct Corner {
  std::int16_t x = 0, y = 0;  ///< pixel of the level
  std::int16_t strength = 0;  ///< gray levels: largest threshold at which it is still a corner

  friend bool operator==(const Corner&, const Corner&) = default;
};

/// A total order: stronger first, then upper, then left.
inline bool stronger(const Corner& a, const Corner& b) {
  if (a.strength != b.strength) return a.strength > b.strength;
  if (a.y != b.y) return a.y < b.y;
  return a.x < b.x;
}

/// FAST-9 corners (Rosten and Drummond, ECCV 2006): 9 contiguous pixels of the 16 on a circle of
/// radius 3 px are all brighter, or all darker, than the center by more than `threshold`. Only
/// corners stronger than their 8 neighbors are kept. Same result as cv::FAST.
/// @param edge_px    minimum distance of corners from the border; at least 4.
/// @param threshold  gray levels, 0 to 255 (which nothing exceeds).
/// @returns corners in the order of rows, then columns.
std::vector<Corner> fast_corners(const cv::Mat& image, int edge_px, int threshold);

/// Offset from a corner's pixel to the peak of strength, at most half a pixel: the peaks of
/// parabolas through the strengths of the 3x3 neighborhood. Measured by reprojection in rendered
/// rooms, this reduces the error of matched level-0 corners from 0.71 to 0.45 px.
/// @pre  the corner is at least kPeakReach_px from the image's border
cv::Point2f peak_of(const cv::Mat& image, const Corner& corner);
inline constexpr int kPeakReach_px = 5;

}  // namespace mh
