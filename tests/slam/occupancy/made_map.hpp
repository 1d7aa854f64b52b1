// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "slam/occupancy/voxel_map.hpp"

namespace mh {

inline constexpr ClassId kChair = 5, kTable = 7;

/// A voxel map made voxel by voxel.
class MadeMap {
 public:
  void free(const Eigen::Vector3i& voxel) { states_[key(voxel)] = {}; }
  void hit(const Eigen::Vector3i& voxel, ClassId label = kVoid, std::uint8_t detection = 0) {
    states_[key(voxel)] = {true, label, detection};
  }
  /// A solid box of voxels, both ends included.
  void box(const Eigen::Vector3i& low, const Eigen::Vector3i& high, ClassId label,
           std::uint8_t detection = 0) {
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) hit({x, y, z}, label, detection);
  }
  /// The voxels as seen in a single view.
  VoxelView view() const {
    std::map<std::tuple<int, int, int>, VoxelBlock> blocks;
    for (const auto& [at, state] : states_) {
      const auto [z, y, x] = at;
      const auto down = [](int v) { return (v >= 0 ? v : v - 7) / 8; };
      VoxelBlock& block = blocks[{down(z), down(y), down(x)}];
      block.index = {down(x), down(y), down(z)};
      const int place = (x - 8 * down(x)) + 8 * (y - 8 * down(y)) + 64 * (z - 8 * down(z));
      auto& bits = state.hit ? block.hit : block.free;
      bits[static_cast<std::size_t>(place / 64)] |= std::uint64_t{1} << (place % 64);
      if (state.label != kVoid)
        block.votes.push_back({static_cast<std::uint16_t>(place), state.label, state.detection});
    }
    VoxelView view;
    for (auto& [index, block] : blocks) view.push_back(block);
    return view;
  }
  VoxelMap map(double resolution_m = 0.05) const {
    VoxelMap map(resolution_m);
    const VoxelView all = view();
    map.replace(nullptr, &all);
    return map;
  }

 private:
  struct State {
    bool hit = false;
    ClassId label = kVoid;
    std::uint8_t detection = 0;
  };
  static std::tuple<int, int, int> key(const Eigen::Vector3i& v) { return {v.z(), v.y(), v.x()}; }
  std::map<std::tuple<int, int, int>, State> states_;
};

}  // namespace mh
