// SPDX-License-Identifier: Apache-2.0
#pragma once

// The octree behind VoxelMap; private to slam/occupancy, so that no other code includes OctoMap.

#include <memory>
#include <span>

#include <octomap/OcTreeNode.h>
#include <octomap/OccupancyOcTreeBase.h>

#include "slam/occupancy/voxel_map.hpp"

namespace mh {

/// The votes of one voxel, ordered by class. An empty list costs only a pointer: most voxels are
/// free space and have no votes.
class VoteList {
 public:
  std::span<const ClassVote> all() const {
    return votes_ ? std::span<const ClassVote>(votes_.get() + 1, votes_[0].views)
                  : std::span<const ClassVote>();
  }
  /// Adds the vote of a view (or, with change = -1, removes it).
  void change(ClassId class_id, int change);
  void assign(std::span<const ClassVote> votes);
  std::size_t memory_bytes() const { return votes_ ? (all().size() + 1) * sizeof(ClassVote) : 0; }

 private:
  std::unique_ptr<ClassVote[]> votes_;  ///< element 0 holds their number as `views`
};

/// A node of the tree: OctoMap's log-odds, and the counts from which they are computed. Only leaves
/// have counts and votes.
class VoxelNode : public octomap::OcTreeNode {
 public:
  VoxelNode() = default;
  VoxelNode(const VoxelNode& other) : OcTreeNode() { copyData(other); }  // without children
  VoxelNode& operator=(const VoxelNode&) = delete;

  bool operator==(const VoxelNode& other) const {
    return value == other.value && hits == other.hits && misses == other.misses;
  }
  void copyData(const VoxelNode& from) {
    OcTreeNode::copyData(from);
    hits = from.hits;
    misses = from.misses;
    votes.assign(from.votes.all());
  }
  /// Computes the log-odds from the counts.
  void follow_counts() {
    const float sum = kHitLogOdds * hits + kMissLogOdds * misses;
    value = std::min(std::max(sum, kLeastLogOdds), kMostLogOdds);
  }
  bool is_known() const { return hits > 0 || misses > 0; }
  /// Frees the array of children. @pre all children were deleted
  void free_children() {
    delete[] children;
    children = nullptr;
  }

  std::uint16_t hits = 0, misses = 0;
  VoteList votes;
};

/// An OctoMap occupancy tree of VoxelNodes. Never pruned: equal log-odds may come from different
/// counts.
class VoxelTree : public octomap::OccupancyOcTreeBase<VoxelNode> {
 public:
  explicit VoxelTree(double resolution_m) : OccupancyOcTreeBase(resolution_m) {}
  VoxelTree* create() const override { return new VoxelTree(resolution); }
  std::string getTreeType() const override { return "ModelhouseVoxelTree"; }
  bool isNodeCollapsible(const VoxelNode*) const override { return false; }

  /// Levels of a block of 8 x 8 x 8 voxels.
  static constexpr unsigned kBlockLevels = 3;
  static constexpr int kMiddle = 32768;  ///< the key of voxel 0

  /// Whether a block is inside the tree.
  static bool holds(const Eigen::Vector3i& block) {
    return (block.array() >= -kMiddle / 8).all() && (block.array() < kMiddle / 8).all();
  }

  /// The node of a block, made if it does not exist.
  VoxelNode& block(const Eigen::Vector3i& index);
  /// The voxel at a place of a block (bit x + 8 y + 64 z), made if it does not exist.
  VoxelNode& voxel(VoxelNode& block, unsigned place);
  /// Deletes the nodes of a block that no view observes any longer, and the block if none is left.
  void drop_untold(const Eigen::Vector3i& index);

 private:
  bool drop_untold_below(VoxelNode& node, unsigned levels);
  bool drop_path(VoxelNode& node, const octomap::OcTreeKey& key, unsigned depth);
};

struct VoxelMap::Impl {
  explicit Impl(double resolution_m) : tree(resolution_m) {}
  /// The voxel at a point; nullptr if it is unknown.
  const VoxelNode* find(const Eigen::Vector3d& point_m) const {
    octomap::OcTreeKey key;
    if (!tree.coordToKeyChecked(point_m.x(), point_m.y(), point_m.z(), key)) return nullptr;
    return tree.search(key);
  }
  VoxelTree tree;
  DetectedObjects detected;
  bool on_floor = true;
};

}  // namespace mh
