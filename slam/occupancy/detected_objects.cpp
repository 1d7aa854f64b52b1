// SPDX-License-Identifier: Apache-2.0
#include "slam/occupancy/detected_objects.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>

#include "slam/occupancy/objects.hpp"
#include "slam/occupancy/voxel_tree.hpp"

namespace mh {
namespace {

using Eigen::Vector3i;

/// A detection belongs to an object that already had at least this share of its voxels. Shares from
/// 0.2 to 0.33 give the same objects in the model house.
constexpr double kLeastShare = 0.25;

}  // namespace

std::uint64_t key_of(const Vector3i& voxel) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis)
    key = key << 21U | static_cast<std::uint64_t>(voxel[axis] + (1 << 20));
  return key;
}

DetectedObjects::DetectedObjects(std::vector<Entry> entries, std::set<std::pair<Id, Id>> apart)
    : entries_(std::move(entries)), apart_(std::move(apart)) {
  std::ranges::sort(entries_, {}, [](const Entry& e) {
    return std::tuple(e.voxel.z(), e.voxel.y(), e.voxel.x());
  });
  at_.reserve(entries_.size());
  for (const Entry& entry : entries_) at_.emplace(key_of(entry.voxel), entry.object);
}

DetectedObjects::Id DetectedObjects::at(const Vector3i& voxel) const {
  const auto found = at_.find(key_of(voxel));
  return found == at_.end() ? Id{0} : found->second;
}

struct DetectionAssociation::Detection {
  ClassId class_id = kVoid;
  std::vector<std::uint64_t> voxels;
  std::map<Object, double>
      before;  ///< by object: its mean share of the earlier votes in the detection's voxels
  Object object = 0;
};

DetectionAssociation::Object DetectionAssociation::most_voted(const std::vector<Votes>& votes,
                                                              ClassId class_id) const {
  Votes best;
  for (const Votes& vote : votes)
    if (classes_[vote.object - 1] == class_id && vote.views > best.views) best = vote;
  return best.object;
}

std::vector<DetectionAssociation::Detection> DetectionAssociation::detections_of(
    const VoxelView& view) const {
  std::map<std::pair<ClassId, std::uint8_t>, Detection> by_number;
  for (const VoxelBlock& block : view) {
    if (!VoxelTree::holds(block.index)) continue;
    for (const VoxelVote& vote : block.votes) {
      if (!is_thing(vote.class_id)) continue;
      Detection& detection = by_number[{vote.class_id, vote.detection}];
      detection.class_id = vote.class_id;
      detection.voxels.push_back(
          key_of(8 * block.index + Vector3i(vote.place % 8, vote.place / 8 % 8, vote.place / 64)));
    }
  }
  std::vector<Detection> detections;
  for (auto& [number, detection] : by_number) {
    for (const std::uint64_t voxel : detection.voxels) {
      const auto known = votes_.find(voxel);
      if (known == votes_.end()) continue;
      double all = 0;
      for (const Votes& vote : known->second)
        if (classes_[vote.object - 1] == detection.class_id) all += vote.views;
      for (const Votes& vote : known->second)
        if (classes_[vote.object - 1] == detection.class_id)
          detection.before[vote.object] += vote.views / all;
    }
    for (auto& [object, share] : detection.before)
      share /= static_cast<double>(detection.voxels.size());
    detections.push_back(std::move(detection));
  }
  return detections;
}

void DetectionAssociation::recognize(std::vector<Detection>& detections) {
  struct Agreement {
    double voxels;
    std::size_t detection;
    Object object;
  };
  std::vector<Agreement> agreements;
  for (std::size_t d = 0; d < detections.size(); ++d)
    for (const auto& [object, share] : detections[d].before)
      if (share >= kLeastShare)
        agreements.push_back({share * static_cast<double>(detections[d].voxels.size()), d, object});
  std::ranges::stable_sort(agreements, std::ranges::greater(), &Agreement::voxels);
  std::set<Object> taken;
  for (const Agreement& best : agreements) {
    Detection& detection = detections[best.detection];
    if (detection.object == 0 && taken.insert(best.object).second) detection.object = best.object;
  }
  for (Detection& detection : detections) {
    if (detection.object != 0) continue;
    classes_.push_back(detection.class_id);
    detection.object = static_cast<Object>(classes_.size());
  }
}

void DetectionAssociation::compare(const std::vector<Detection>& detections) {
  std::set<Object> recognized;
  for (const Detection& detection : detections) recognized.insert(detection.object);
  // By class, then object: the detections that show the object.
  std::map<ClassId, std::map<Object, std::set<std::size_t>>> shown;
  for (std::size_t d = 0; d < detections.size(); ++d) {
    auto& of_class = shown[detections[d].class_id];
    of_class[detections[d].object].insert(d);
    for (const auto& [object, share] : detections[d].before)
      if (share >= kLeastShare && !recognized.contains(object)) of_class[object].insert(d);
  }
  for (const auto& [class_id, objects] : shown)
    for (auto a = objects.begin(); a != objects.end(); ++a)
      for (auto b = std::next(a); b != objects.end(); ++b) {
        const bool together =
            std::ranges::any_of(a->second, [&](std::size_t d) { return b->second.contains(d); });
        Pair& pair = pairs_[{a->first, b->first}];
        ++(together ? pair.together : pair.apart);
      }
}

void DetectionAssociation::add(const VoxelView& view) {
  std::vector<Detection> detections = detections_of(view);
  recognize(detections);
  compare(detections);
  for (const Detection& detection : detections)
    for (const std::uint64_t voxel : detection.voxels) {
      std::vector<Votes>& votes = votes_[voxel];
      const auto own = std::ranges::find(votes, detection.object, &Votes::object);
      if (own == votes.end())
        votes.push_back({detection.object, 1});
      else
        ++own->views;
    }
}

DetectedObjects DetectionAssociation::objects(const VoxelMap& map) const {
  std::vector<std::pair<Vector3i, Object>> voxels;
  std::map<Object, DetectedObjects::Id> ids;
  map.for_each([&](const Voxel& voxel) {
    if (!voxel.occupied || !is_thing(voxel.label)) return;
    const auto found = votes_.find(key_of(voxel.index));
    if (found == votes_.end()) return;
    if (const Object object = most_voted(found->second, voxel.label); object != 0) {
      voxels.emplace_back(voxel.index, object);
      ids.emplace(object, 0);
    }
  });
  DetectedObjects::Id next = 0;
  for (auto& [object, id] : ids) {
    if (next == std::numeric_limits<DetectedObjects::Id>::max()) break;  // the rest get no id
    id = ++next;
  }
  std::vector<DetectedObjects::Entry> entries;
  for (const auto& [voxel, object] : voxels)
    if (const DetectedObjects::Id id = ids.at(object); id != 0) entries.push_back({voxel, id});
  std::set<std::pair<DetectedObjects::Id, DetectedObjects::Id>> apart;
  for (const auto& [pair, views] : pairs_) {
    if (views.apart <= views.together) continue;
    const auto a = ids.find(pair.first), b = ids.find(pair.second);
    if (a != ids.end() && b != ids.end() && a->second != 0 && b->second != 0)
      apart.emplace(a->second, b->second);  // a has the smaller id: ids follow the order of objects
  }
  return {std::move(entries), std::move(apart)};
}

}  // namespace mh
