// SPDX-License-Identifier: Apache-2.0
#include "slam/map/position_index.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace mh {

PositionIndex::Cell PositionIndex::cell_of(const Eigen::Vector3d& position_in_world) {
  Cell cell{};
  // Clamped, so that a diverged pose still has a cell.
  for (int axis = 0; axis < 3; ++axis)
    cell[static_cast<std::size_t>(axis)] =
        static_cast<int>(std::clamp(std::floor(position_in_world[axis] / kCell_m), -1e9, 1e9));
  return cell;
}

void PositionIndex::add(KeyframeId keyframe, const Eigen::Vector3d& position_in_world) {
  cells_[cell_of(position_in_world)].push_back(keyframe);
}

void PositionIndex::remove(KeyframeId keyframe, const Eigen::Vector3d& position_in_world) {
  const auto cell = cells_.find(cell_of(position_in_world));
  assert(cell != cells_.end());
  std::erase(cell->second, keyframe);
  if (cell->second.empty()) cells_.erase(cell);
}

std::vector<KeyframeId> PositionIndex::near(const Eigen::Vector3d& center_in_world,
                                            double radius_m) const {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius_m);
  const Cell low = cell_of(center_in_world - reach), high = cell_of(center_in_world + reach);
  std::vector<KeyframeId> found;
  // Cells are ordered by x, then y, then z. A cell outside the box is skipped by a jump to the next
  // occupied cell that may be inside, so that a large ball costs no more than the occupied cells.
  for (auto at = cells_.lower_bound(low); at != cells_.end();) {
    Cell next = at->first;
    if (next[0] > high[0]) break;
    if (next[1] < low[1]) {
      next[1] = low[1], next[2] = low[2];
    } else if (next[1] > high[1]) {
      ++next[0], next[1] = low[1], next[2] = low[2];
    } else if (next[2] < low[2]) {
      next[2] = low[2];
    } else if (next[2] > high[2]) {
      ++next[1], next[2] = low[2];
    } else {
      found.insert(found.end(), at->second.begin(), at->second.end());
      ++at;
      continue;
    }
    at = cells_.lower_bound(next);
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace mh
