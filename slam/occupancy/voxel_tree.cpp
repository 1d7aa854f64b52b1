// SPDX-License-Identifier: Apache-2.0
#include "slam/occupancy/voxel_tree.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

namespace mh {
namespace {

octomap::OcTreeKey key_of_block(const Eigen::Vector3i& index) {
  const Eigen::Vector3i voxel = (8 * index).array() + VoxelTree::kMiddle;
  return {static_cast<octomap::key_type>(voxel.x()), static_cast<octomap::key_type>(voxel.y()),
          static_cast<octomap::key_type>(voxel.z())};
}

/// Which child contains a place of the block, for a node `level` levels above the voxels.
unsigned child_of(unsigned place, unsigned level) {
  const unsigned x = place >> level & 1U, y = place >> (3 + level) & 1U,
                 z = place >> (6 + level) & 1U;
  return x | y << 1U | z << 2U;
}

}  // namespace

void VoteList::change(ClassId class_id, int change) {
  const std::span<const ClassVote> old = all();
  const auto at = static_cast<std::size_t>(
      std::ranges::lower_bound(old, class_id, {}, &ClassVote::class_id) - old.begin());
  if (at < old.size() && old[at].class_id == class_id) {
    ClassVote& vote = votes_[at + 1];
    vote.views = static_cast<std::uint16_t>(vote.views + change);
    if (vote.views > 0) return;
    std::vector<ClassVote> rest(old.begin(), old.end());
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(at));
    assign(rest);
    return;
  }
  assert(change > 0);
  std::vector<ClassVote> more(old.begin(), old.end());
  more.insert(more.begin() + static_cast<std::ptrdiff_t>(at),
              {class_id, static_cast<std::uint16_t>(change)});
  assign(more);
}

void VoteList::assign(std::span<const ClassVote> votes) {
  if (votes.empty()) {
    votes_.reset();
    return;
  }
  auto list = std::make_unique<ClassVote[]>(votes.size() + 1);
  list[0].views = static_cast<std::uint16_t>(votes.size());
  std::copy(votes.begin(), votes.end(), list.get() + 1);
  votes_ = std::move(list);
}

VoxelNode& VoxelTree::block(const Eigen::Vector3i& index) {
  if (root == nullptr) {
    root = new VoxelNode();
    ++tree_size;
  }
  const octomap::OcTreeKey key = key_of_block(index);
  VoxelNode* node = root;
  for (unsigned depth = 0; depth < tree_depth - kBlockLevels; ++depth) {
    const unsigned child = octomap::computeChildIdx(key, static_cast<int>(tree_depth - 1 - depth));
    if (!nodeChildExists(node, child)) createNodeChild(node, child);
    node = getNodeChild(node, child);
  }
  size_changed = true;
  return *node;
}

VoxelNode& VoxelTree::voxel(VoxelNode& block, unsigned place) {
  VoxelNode* node = &block;
  for (unsigned level = kBlockLevels; level-- > 0;) {
    const unsigned child = child_of(place, level);
    if (!nodeChildExists(node, child)) createNodeChild(node, child);
    node = getNodeChild(node, child);
  }
  return *node;
}

bool VoxelTree::drop_untold_below(VoxelNode& node, unsigned levels) {
  if (levels == 0) return !node.is_known();
  bool is_empty = true;
  for (unsigned child = 0; child < 8; ++child) {
    if (!nodeChildExists(&node, child)) continue;
    if (drop_untold_below(*getNodeChild(&node, child), levels - 1))
      deleteNodeChild(&node, child);
    else
      is_empty = false;
  }
  if (is_empty) node.free_children();
  return is_empty;
}

bool VoxelTree::drop_path(VoxelNode& node, const octomap::OcTreeKey& key, unsigned depth) {
  if (depth == tree_depth - kBlockLevels) return drop_untold_below(node, kBlockLevels);
  const unsigned child = octomap::computeChildIdx(key, static_cast<int>(tree_depth - 1 - depth));
  if (!nodeChildExists(&node, child)) return false;
  if (!drop_path(*getNodeChild(&node, child), key, depth + 1)) return false;
  deleteNodeChild(&node, child);
  for (unsigned other = 0; other < 8; ++other)
    if (nodeChildExists(&node, other)) return false;
  node.free_children();
  return true;
}

void VoxelTree::drop_untold(const Eigen::Vector3i& index) {
  if (root == nullptr || !drop_path(*root, key_of_block(index), 0)) return;
  clear();  // no counts are left
}

}  // namespace mh
