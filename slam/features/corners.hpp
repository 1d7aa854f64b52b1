// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace mh {

/// A corner on one pyramid level.
struct Corner {
  std::int16_t x = 0, y = 0;  ///< pixel of the level
  std::int16_t strength = 0;  ///< grey levels: largest threshold at which it still is a corner

  friend bool operator==(const Corner&, const Corner&) = default;
};

/// A total order: stronger first, then upper, then left.
inline bool stronger(const Corner& a, const Corner& b) {
  if (a.strength != b.strength) return a.strength > b.strength;
  if (a.y != b.y) return a.y < b.y;
  return a.x < b.x;
}

/// FAST-9 corners (Rosten and Drummond, ECCV 2006) at least `edge_px` from the border, local maxima
/// only. Cells of about 36 px in which `threshold` finds nothing are searched again with
/// `low_threshold`. Strongest first.
std::vector<Corner> find_corners(const cv::Mat& image, int edge_px, int threshold,
                                 int low_threshold);

/// Picks `count` corners that are strong and spread evenly: the greatest spacing is sought at which
/// taking corners from the strongest down, none closer to one already taken than the spacing
/// (larger of |dx| and |dy|), still yields `count` (adaptive non-maximal suppression after Bailo et
/// al., Pattern Recognition Letters 2018).
/// @param corners  strongest first.
/// @returns min(count, corners.size()) corners, strongest first.
std::vector<Corner> spread(const std::vector<Corner>& corners, int count);

/// Shares `total` features out to levels in a geometric series of ratio `ratio`, finest level
/// first. What a level cannot supply goes to others, the finest first.
/// @param available  corners found per level.
std::vector<int> share_out(int total, double ratio, const std::vector<int>& available);

}  // namespace mh
