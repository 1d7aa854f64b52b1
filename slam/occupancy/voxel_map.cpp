// SPDX-License-Identifier: Apache-2.0
#include "slam/occupancy/voxel_map.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <tuple>

#include "slam/occupancy/voxel_tree.hpp"

namespace mh {
namespace {

auto order_of(const Eigen::Vector3i& block) {
  return std::make_tuple(block.z(), block.y(), block.x());
}

/// Calls f(place) for each set bit.
template <class F>
void for_each_bit(const VoxelBlock::Bits& bits, F f) {
  for (std::size_t word = 0; word < bits.size(); ++word)
    for (std::uint64_t rest = bits[word]; rest != 0; rest &= rest - 1)
      f(static_cast<unsigned>(64 * word) + static_cast<unsigned>(std::countr_zero(rest)));
}

VoxelBlock::Bits without(const VoxelBlock::Bits& a, const VoxelBlock::Bits& b) {
  VoxelBlock::Bits left;
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = a[i] & ~b[i];
  return left;
}

bool is_any(const VoxelBlock::Bits& bits) {
  return std::ranges::any_of(bits, [](std::uint64_t word) { return word != 0; });
}

/// Replaces one view's contribution to a block with another's.
void replace_block(VoxelTree& tree, const VoxelBlock& before, const VoxelBlock& after) {
  const VoxelBlock::Bits free = without(after.free, before.free),
                         not_free = without(before.free, after.free),
                         hit = without(after.hit, before.hit),
                         not_hit = without(before.hit, after.hit);
  const bool votes_differ = before.votes != after.votes;
  if (!votes_differ && !is_any(free) && !is_any(not_free) && !is_any(hit) && !is_any(not_hit))
    return;
  VoxelNode& block = tree.block(after.index);
  const auto count = [&](const VoxelBlock::Bits& bits, std::uint16_t VoxelNode::*number, int by) {
    for_each_bit(bits, [&](unsigned place) {
      VoxelNode& voxel = tree.voxel(block, place);
      voxel.*number = static_cast<std::uint16_t>(voxel.*number + by);
      voxel.follow_counts();
    });
  };
  count(free, &VoxelNode::misses, 1);
  count(hit, &VoxelNode::hits, 1);
  count(not_free, &VoxelNode::misses, -1);
  count(not_hit, &VoxelNode::hits, -1);
  if (votes_differ) {
    for (const VoxelVote& vote : after.votes)
      tree.voxel(block, vote.place).votes.change(vote.class_id, 1);
    for (const VoxelVote& vote : before.votes)
      tree.voxel(block, vote.place).votes.change(vote.class_id, -1);
  }
  if (is_any(not_free) || is_any(not_hit)) tree.drop_untold(after.index);
}

Voxel voxel_of(const octomap::OcTreeKey& key, const VoxelNode& node) {
  Voxel voxel;
  for (int axis = 0; axis < 3; ++axis)
    voxel.index[axis] = int{key[static_cast<unsigned>(axis)]} - VoxelTree::kMiddle;
  voxel.hits = node.hits;
  voxel.misses = node.misses;
  voxel.occupied = node.getLogOdds() >= 0;
  for (const ClassVote& vote : node.votes.all()) {
    voxel.votes += vote.views;
    if (vote.views <= voxel.label_views) continue;
    voxel.label = vote.class_id;
    voxel.label_views = vote.views;
  }
  return voxel;
}

}  // namespace

VoxelMap::VoxelMap(double resolution_m) : impl_(std::make_unique<Impl>(resolution_m)) {
  assert(resolution_m > 0);
}
VoxelMap::~VoxelMap() = default;
VoxelMap::VoxelMap(VoxelMap&&) noexcept = default;
VoxelMap& VoxelMap::operator=(VoxelMap&&) noexcept = default;

double VoxelMap::resolution_m() const {
  return impl_->tree.getResolution();
}

void VoxelMap::replace(const VoxelView* before, const VoxelView* after) {
  static const VoxelView kNothing;
  const VoxelView& old = before ? *before : kNothing;
  const VoxelView& now = after ? *after : kNothing;
  auto o = old.begin();
  auto n = now.begin();
  while (o != old.end() || n != now.end()) {
    const bool take_old =
        o != old.end() && (n == now.end() || order_of(o->index) <= order_of(n->index));
    const bool take_new =
        n != now.end() && (o == old.end() || order_of(n->index) <= order_of(o->index));
    VoxelBlock nothing;
    nothing.index = take_old ? o->index : n->index;
    if (VoxelTree::holds(nothing.index))
      replace_block(impl_->tree, take_old ? *o : nothing, take_new ? *n : nothing);
    if (take_old) ++o;
    if (take_new) ++n;
  }
}

void VoxelMap::set_detected(DetectedObjects objects) {
  impl_->detected = std::move(objects);
}

const DetectedObjects& VoxelMap::detected() const {
  return impl_->detected;
}

void VoxelMap::set_on_floor(bool on_floor) {
  impl_->on_floor = on_floor;
}

bool VoxelMap::on_floor() const {
  return impl_->on_floor;
}

VoxelState VoxelMap::state_at(const Eigen::Vector3d& point_m) const {
  const VoxelNode* node = impl_->find(point_m);
  if (node == nullptr) return VoxelState::kUnknown;
  return node->getLogOdds() >= 0 ? VoxelState::kOccupied : VoxelState::kFree;
}

void VoxelMap::for_each(const std::function<void(const Voxel&)>& visit) const {
  const VoxelTree& tree = impl_->tree;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
    visit(voxel_of(leaf.getKey(), *leaf));
}

std::vector<ClassVote> VoxelMap::votes_at(const Eigen::Vector3d& point_m) const {
  const VoxelNode* node = impl_->find(point_m);
  if (node == nullptr) return {};
  return {node->votes.all().begin(), node->votes.all().end()};
}

std::size_t VoxelMap::voxel_count() const {
  return impl_->tree.getNumLeafNodes();
}

std::size_t VoxelMap::memory_bytes() const {
  std::size_t bytes = impl_->tree.memoryUsage();
  for (auto leaf = impl_->tree.begin_leafs(), end = impl_->tree.end_leafs(); leaf != end; ++leaf)
    bytes += leaf->votes.memory_bytes();
  return bytes;
}

}  // namespace mh
