// SPDX-License-Identifier: Apache-2.0
#include "slam/features/feature_grid.hpp"

#include <algorithm>
#include <cmath>

namespace mh {

FeatureGrid::FeatureGrid(const std::vector<Keypoint>& keypoints, const Camera& camera)
    : columns_(static_cast<int>(std::ceil(static_cast<float>(camera.width_px) / kCell_px))),
      rows_(static_cast<int>(std::ceil(static_cast<float>(camera.height_px) / kCell_px))),
      start_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0),
      entries_(keypoints.size()) {
  // Counting sort: stable, so keypoints of a cell keep their order.
  for (const Keypoint& k : keypoints) ++start_[cell(column(k.u_px), row(k.v_px)) + 1];
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  for (std::uint32_t i = 0; i < keypoints.size(); ++i) {
    const Keypoint& k = keypoints[i];
    entries_[next[cell(column(k.u_px), row(k.v_px))]++] = {k.u_px, k.v_px, k.octave, i};
  }
}

int FeatureGrid::column(float u_px) const {
  return std::clamp(static_cast<int>(std::floor(u_px / kCell_px)), 0, columns_ - 1);
}
int FeatureGrid::row(float v_px) const {
  return std::clamp(static_cast<int>(std::floor(v_px / kCell_px)), 0, rows_ - 1);
}

}  // namespace mh
