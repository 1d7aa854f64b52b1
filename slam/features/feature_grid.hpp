// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slam/core/camera.hpp"
#include "slam/features/features.hpp"

namespace mh {

/// Keypoints of one frame in square cells, to find those near a pixel without a full scan.
class FeatureGrid {
 public:
  FeatureGrid() = default;
  FeatureGrid(const std::vector<Keypoint>& keypoints, const Camera& camera);

  /// The part of a keypoint that a search reads, contiguous in memory.
  struct Entry {
    float u_px, v_px;
    std::int32_t octave;
    std::uint32_t index;
  };

  /// Calls visit(Entry) for every keypoint whose cell touches the square of half-width radius_px
  /// around (u_px, v_px): a superset of the keypoints inside, in an order that depends on the input
  /// alone.
  template <class Visit>
  void for_each_near(float u_px, float v_px, float radius_px, Visit visit) const {
    const int x0 = column(u_px - radius_px), x1 = column(u_px + radius_px);
    const int y0 = row(v_px - radius_px), y1 = row(v_px + radius_px);
    for (int y = y0; y <= y1; ++y)
      for (std::uint32_t i = start_[cell(x0, y)]; i < start_[cell(x1, y) + 1]; ++i)
        visit(entries_[i]);
  }

 private:
  static constexpr float kCell_px = 16.0F;
  int column(float u_px) const;
  int row(float v_px) const;
  std::size_t cell(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(x);
  }

  int columns_ = 0, rows_ = 0;
  std::vector<std::uint32_t> start_;  // start of each cell in entries_, plus the end
  std::vector<Entry> entries_;        // by cell
};

}  // namespace mh
