// SPDX-License-Identifier: Apache-2.0
#include "slam/map/map.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

#include "slam/features/scale.hpp"

namespace mh {
namespace {

/// Index of the descriptor with the least median Hamming distance to the others; ties to the first.
std::size_t most_central(const std::vector<const Descriptor*>& descriptors) {
  const std::size_t n = descriptors.size();
  if (n <= 2) return 0;
  std::vector<int> distances(n);
  // A descriptor's distance to itself (0) sorts first, so this is the index of the median of the
  // others.
  const std::size_t median = 1 + (n - 1) / 2;
  std::size_t best = 0;
  int best_median = INT32_MAX;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) distances[j] = hamming(*descriptors[i], *descriptors[j]);
    // Counting is a faster test than sorting for whether this descriptor's median is below the best
    // one.
    const auto below = std::count_if(distances.begin(), distances.end(),
                                     [&](int distance) { return distance < best_median; });
    if (static_cast<std::size_t>(below) <= median) continue;
    std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(median),
                     distances.end());
    best_median = distances[median];
    best = i;
  }
  return best;
}

}  // namespace

Map Map::restore(std::vector<Keyframe> keyframes, std::vector<Landmark> landmarks) {
  Map map;
  map.keyframes_ = std::move(keyframes);
  for (Landmark& l : landmarks) {
    if (!l.erased) ++map.landmark_count_;
    map.landmarks_.add(std::move(l));
  }
  for (const Keyframe& k : map.keyframes_)
    if (!k.erased) {
      map.inverted_index_.add(k.id, k.words.vector);
      map.position_index_.add(k.id, k.camera_from_world.inverse().translation());
    }
  const auto standing = [](const auto& entity) { return !entity.erased; };
  map.keyframe_count_ =
      static_cast<int>(std::count_if(map.keyframes_.begin(), map.keyframes_.end(), standing));
  map.check_invariants();
  return map;
}

KeyframeId Map::add(Keyframe keyframe) {
  keyframe.id = KeyframeId{static_cast<std::uint32_t>(keyframes_.size())};
  if (!keyframe.origin.valid()) keyframe.origin = keyframe.id;
  keyframe.landmarks.assign(keyframe.features.size(), LandmarkId{});
  keyframe.covisible.clear();
  inverted_index_.add(keyframe.id, keyframe.words.vector);
  position_index_.add(keyframe.id, keyframe.camera_from_world.inverse().translation());
  keyframes_.push_back(std::move(keyframe));
  ++keyframe_count_;
  return keyframes_.back().id;
}

void Map::set_words(KeyframeId id, WordIndex words) {
  Keyframe& keyframe = mutable_at(id);
  assert(!keyframe.erased);
  inverted_index_.erase(id, keyframe.words.vector);
  keyframe.words = std::move(words);
  inverted_index_.add(id, keyframe.words.vector);
}

LandmarkId Map::add_landmark(const Eigen::Vector3d& position_in_world, KeyframeId keyframe,
                             std::uint32_t feature) {
  Landmark landmark;
  landmark.position_in_world = position_in_world;
  landmark.first_keyframe = keyframe;
  const LandmarkId id = landmarks_.add(std::move(landmark));
  ++landmark_count_;
  [[maybe_unused]] const bool added = add_observation(id, keyframe, feature);
  assert(added);
  return id;
}

bool Map::add_observation(LandmarkId landmark, KeyframeId keyframe, std::uint32_t feature) {
  Landmark* l = landmarks_.find(landmark);
  Keyframe& k = mutable_at(keyframe);
  if (l == nullptr || k.erased || k.landmarks[feature].valid()) return false;
  const auto place =
      std::lower_bound(l->observations.begin(), l->observations.end(), keyframe,
                       [](const Observation& o, KeyframeId wanted) { return o.keyframe < wanted; });
  if (place != l->observations.end() && place->keyframe == keyframe) return false;
  l->observations.insert(place, {keyframe, feature});
  l->described = false;
  k.landmarks[feature] = landmark;
  return true;
}

void Map::erase_observation(LandmarkId landmark, KeyframeId keyframe) {
  Landmark* l = landmarks_.find(landmark);
  if (l == nullptr) return;
  const auto place = std::find_if(l->observations.begin(), l->observations.end(),
                                  [&](const Observation& o) { return o.keyframe == keyframe; });
  if (place == l->observations.end()) return;
  mutable_at(keyframe).landmarks[place->feature] = LandmarkId{};
  l->observations.erase(place);
  l->described = false;
  if (l->observations.empty()) erase(landmark);
}

void Map::erase(LandmarkId landmark) {
  const Landmark* l = landmarks_.find(landmark);
  if (l == nullptr) return;
  for (const Observation& o : l->observations)
    mutable_at(o.keyframe).landmarks[o.feature] = LandmarkId{};
  landmarks_.erase(landmark);
  --landmark_count_;
}

void Map::fuse(LandmarkId from, LandmarkId into) {
  if (from == into || at(from).erased || at(into).erased) return;
  const std::vector<Observation> moved = at(from).observations;
  const int visible = at(from).visible;
  const int found = at(from).found;
  erase(from);
  for (const Observation& o : moved) add_observation(into, o.keyframe, o.feature);
  landmarks_.find(into)->visible += visible;
  landmarks_.find(into)->found += found;
}

void Map::erase(KeyframeId keyframe) {
  Keyframe& k = mutable_at(keyframe);
  if (k.erased || k.origin == keyframe) return;
  KeyframeId parent = k.covisible.empty() ? KeyframeId{} : k.covisible.front().id;
  if (!parent.valid())  // it has no neighbor: attach it to the nearest live keyframe in time
    for (const Keyframe& other : keyframes_)
      if (!other.erased && other.origin == k.origin && other.id != keyframe &&
          (!parent.valid() || other.id < keyframe))
        parent = other.id;
  for (std::uint32_t i = 0; i < k.landmarks.size(); ++i)
    if (k.landmarks[i].valid()) erase_observation(k.landmarks[i], keyframe);
  for (const Keyframe::Neighbor& n : std::vector(k.covisible)) set_neighbor(n.id, keyframe, 0);
  k.covisible.clear();
  k.parent = parent;
  k.camera_from_parent = k.camera_from_world * at(parent).camera_from_world.inverse();
  k.erased = true;
  inverted_index_.erase(keyframe, k.words.vector);
  position_index_.remove(keyframe, k.camera_from_world.inverse().translation());
  k.features = {};  // no longer needed: a long run must not fill the memory
  k.grid = {};
  k.words = {};
  k.landmarks = {};
  --keyframe_count_;
}

void Map::join(KeyframeId origin, KeyframeId into, const SE3& into_from_origin) {
  const SE3 origin_from_into = into_from_origin.inverse();
  for (const Landmark& l : landmarks_)
    if (!l.erased && at(l.observations.front().keyframe).origin == origin)
      set_position(l.id, into_from_origin * l.position_in_world);
  for (Keyframe& k : keyframes_) {
    if (k.origin != origin) continue;
    k.origin = into;
    if (!k.erased) set_pose(k.id, k.camera_from_world * origin_from_into);
  }
}

void Map::set_pose(KeyframeId id, const SE3& camera_from_world) {
  Keyframe& k = mutable_at(id);
  assert(!k.erased);
  position_index_.remove(id, k.camera_from_world.inverse().translation());
  position_index_.add(id, camera_from_world.inverse().translation());
  k.camera_from_world = camera_from_world;
}

void Map::describe(Landmark& l) const {
  std::vector<const Descriptor*> descriptors;
  for (const Observation& o : l.observations)
    descriptors.push_back(&at(o.keyframe).features.descriptors[o.feature]);
  const std::size_t central = most_central(descriptors);
  l.descriptor = *descriptors[central];
  const Observation& o = l.observations[central];
  l.label = at(o.keyframe).features.keypoints[o.feature].label;
  l.described = true;
}

void Map::refresh(LandmarkId id, const FeatureConfig& config) {
  Landmark* standing = landmarks_.find(id);
  if (standing == nullptr) return;
  Landmark& l = *standing;
  if (!l.described) describe(l);
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  for (const Observation& o : l.observations)
    direction += (l.position_in_world - at(o.keyframe).camera_from_world.inverse().translation())
                     .normalized();
  l.mean_direction = direction.norm() > 1e-9 ? Eigen::Vector3d(direction.normalized())
                                             : Eigen::Vector3d(Eigen::Vector3d::UnitZ());

  // A corner seen at octave o from distance d is visible at octave 0 from scale^o times as far away
  // (max), and at the coarsest octave from that distance divided by scale^(levels - 1) (min).
  const Observation& reference = l.observations.front();
  const Keyframe& k = at(reference.keyframe);
  const double distance = (k.camera_from_world * l.position_in_world).norm();
  const int octave = k.features.keypoints[reference.feature].octave;
  l.max_distance_m = distance * level_scale(config, octave);
  l.min_distance_m = l.max_distance_m / level_scale(config, config.levels - 1);
}

void Map::set_neighbor(KeyframeId of, KeyframeId neighbor, int shared) {
  auto& covisible = mutable_at(of).covisible;
  std::erase_if(covisible, [&](const Keyframe::Neighbor& n) { return n.id == neighbor; });
  if (shared < kMinShared) return;
  const auto place =
      std::find_if(covisible.begin(), covisible.end(), [&](const Keyframe::Neighbor& n) {
        return n.shared != shared ? n.shared < shared : neighbor < n.id;
      });
  covisible.insert(place, {neighbor, shared});
}

void Map::update_covisibility(KeyframeId id) {
  if (at(id).erased) return;
  std::map<KeyframeId, int> shared;
  for (const LandmarkId landmark : at(id).landmarks)
    if (landmark.valid())
      for (const Observation& o : at(landmark).observations)
        if (o.keyframe != id) ++shared[o.keyframe];
  for (const Keyframe::Neighbor& n : std::vector(at(id).covisible))
    if (!shared.contains(n.id)) shared[n.id] = 0;
  for (const auto& [other, count] : shared) {
    set_neighbor(id, other, count);
    set_neighbor(other, id, count);
  }
}

SE3 Map::camera_from_world(KeyframeId id) const {
  SE3 camera_from_here;
  while (at(id).erased) {
    camera_from_here = camera_from_here * at(id).camera_from_parent;
    id = at(id).parent;
  }
  return camera_from_here * at(id).camera_from_world;
}

KeyframeId Map::live_keyframe(KeyframeId id) const {
  while (at(id).erased) id = at(id).parent;
  return id;
}

void Map::check_invariants() const {
  const auto require = [](bool good, const char* what, std::uint32_t id) {
    if (!good) throw std::logic_error(fmt::format("map: {} (id {})", what, id));
  };
  for (const Keyframe& k : keyframes_) {
    if (k.erased) {
      require(k.covisible.empty() && k.landmarks.empty(),
              "an erased keyframe still has landmarks or neighbors", k.id.value);
      continue;
    }
    const auto near = keyframes_near(k.camera_from_world.inverse().translation(), 0.0);
    require(std::binary_search(near.begin(), near.end(), k.id),
            "a keyframe is not found at its position", k.id.value);
    for (std::uint32_t i = 0; i < k.landmarks.size(); ++i) {
      if (!k.landmarks[i].valid()) continue;
      const Landmark& l = at(k.landmarks[i]);
      require(!l.erased, "a keyframe names an erased landmark", k.id.value);
      require(std::find(l.observations.begin(), l.observations.end(), Observation{k.id, i}) !=
                  l.observations.end(),
              "a landmark does not list its keyframe", l.id.value);
    }
    for (const Keyframe::Neighbor& n : k.covisible) {
      const auto& back = at(n.id).covisible;
      require(std::any_of(back.begin(), back.end(),
                          [&](const auto& b) { return b.id == k.id && b.shared == n.shared; }),
              "covisibility is not symmetric", k.id.value);
    }
  }
  for (const Landmark& l : landmarks_) {
    require(l.erased == l.observations.empty(),
            "a landmark is unobserved but not erased, or the reverse", l.id.value);
    for (const Observation& o : l.observations)
      require(!at(o.keyframe).erased && at(o.keyframe).landmarks[o.feature] == l.id,
              "a keyframe does not list its landmark", l.id.value);
  }
}

}  // namespace mh
