// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "slam/occupancy/voxel_map.hpp"

namespace mh {

/// A voxel map made voxel by voxel.
class MadeMap {
 public:
  void free(const Eigen::Vector3i& voxel) { states_[key(voxel)] = {false, kVoid}; }
  void hit(const Eigen::Vector3i& voxel, ClassId label = kVoid) {
    states_[key(voxel)] = {true, label};
  }
  /// A solid box of voxels, both ends included.
  void box(const Eigen::Vector3i& low, const Eigen::Vector3i& high, ClassId label) {
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) hit({x, y, z}, label);
  }
  VoxelMap map(double resolution_m = 0.05) const {
    std::map<std::tuple<int, int, int>, VoxelBlock> blocks;
    for (const auto& [at, state] : states_) {
      const auto [z, y, x] = at;
      const auto down = [](int v) { return (v >= 0 ? v : v - 7) / 8; };
      VoxelBlock& block = blocks[{down(z), down(y), down(x)}];
      block.index = {down(x), down(y), down(z)};
      const int place = (x - 8 * down(x)) + 8 * (y - 8 * down(y)) + 64 * (z - 8 * down(z));
      auto& bits = state.first ? block.hit : block.free;
      bits[static_cast<std::size_t>(place / 64)] |= std::uint64_t{1} << (place % 64);
      if (state.second != kVoid) block.votes.emplace_back(place, state.second);
    }
    VoxelView view;
    for (auto& [index, block] : blocks) view.push_back(block);
    VoxelMap map(resolution_m);
    map.replace(nullptr, &view);
    return map;
  }

 private:
  static std::tuple<int, int, int> key(const Eigen::Vector3i& v) { return {v.z(), v.y(), v.x()}; }
  std::map<std::tuple<int, int, int>, std::pair<bool, ClassId>> states_;
};

}  // namespace mh
