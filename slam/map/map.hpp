// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "slam/core/ids.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"
#include "slam/features/feature_grid.hpp"
#include "slam/features/features.hpp"
#include "slam/map/landmark_table.hpp"
#include "slam/map/position_index.hpp"
#include "slam/semantics/augmented_vector.hpp"
#include "slam/vocabulary/inverted_index.hpp"
#include "slam/vocabulary/word_index.hpp"

namespace mh {

struct Keyframe {
  KeyframeId id;
  Stamp stamp_ns = 0;
  SE3 camera_from_world;
  Features features;
  FeatureGrid grid;
  WordIndex words;
  std::vector<LandmarkId> landmarks;  ///< per feature; invalid = none

  struct Neighbor {
    KeyframeId id;
    int shared = 0;  ///< landmarks seen by both
  };
  std::vector<Neighbor> covisible;  ///< at least kMinShared; most shared first, then by id

  bool erased = false;
  KeyframeId parent;       ///< what an erased keyframe's pose hangs on
  SE3 camera_from_parent;  ///< valid if erased
};

/// Keyframes, landmarks and who sees whom. Entities are addressed by id; erased ones stay as
/// tombstones. Invariants (check_invariants()): an observation and the keyframe's
/// landmark slot always name each other; erased entities are named by nobody; covisibility is
/// symmetric.
class Map {
 public:
  /// Least number of shared landmarks that makes two keyframes neighbors.
  static constexpr int kMinShared = 15;

  const std::vector<Keyframe>& keyframes() const { return keyframes_; }
  const LandmarkTable& landmarks() const { return landmarks_; }
  const Keyframe& at(KeyframeId id) const { return keyframes_[id.value]; }
  const Landmark& at(LandmarkId id) const { return landmarks_[id]; }
  int keyframe_count() const { return keyframe_count_; }
  int landmark_count() const { return landmark_count_; }
  bool empty() const { return keyframe_count_ == 0; }

  /// A map of these parts, as keyframes() and landmarks() gave them; ids within range are taken for
  /// granted. @throws std::logic_error naming the invariant that they break.
  static Map restore(std::vector<Keyframe> keyframes, std::vector<Landmark> landmarks);

  /// Takes over a keyframe without landmarks; gives it its id.
  KeyframeId add(Keyframe keyframe);
  LandmarkId add_landmark(const Eigen::Vector3d& position_in_world, KeyframeId keyframe,
                          std::uint32_t feature);
  /// No effect if the keyframe sees the landmark already or the feature has one.
  bool add_observation(LandmarkId landmark, KeyframeId keyframe, std::uint32_t feature);
  /// Erases the landmark when nobody is left to see it.
  void erase_observation(LandmarkId landmark, KeyframeId keyframe);
  void erase(LandmarkId landmark);
  /// Moves the observations of `from` to `into` (where a keyframe sees both, into's stays), then
  /// erases `from`.
  void fuse(LandmarkId from, LandmarkId into);
  /// Erases a keyframe; its pose hangs on its best neighbor from then on. The last one stays.
  void erase(KeyframeId keyframe);

  void set_pose(KeyframeId id, const SE3& camera_from_world);
  void set_position(LandmarkId id, const Eigen::Vector3d& position_in_world) {
    if (Landmark* l = landmarks_.find(id)) l->position_in_world = position_in_world;
  }
  /// Describes a standing keyframe's view anew.
  void set_words(KeyframeId id, WordIndex words);
  void count_visible(LandmarkId id) {
    if (Landmark* l = landmarks_.find(id)) ++l->visible;
  }
  void count_found(LandmarkId id) {
    if (Landmark* l = landmarks_.find(id)) ++l->found;
  }

  /// Brings descriptor, label, mean direction and distance range of a landmark up to date.
  void refresh(LandmarkId id, const FeatureConfig& config);
  /// Counts anew which keyframes share landmarks with this one, on both sides.
  void update_covisibility(KeyframeId id);

  /// Standing keyframes that share labels or words with a view, by id.
  std::vector<InvertedIndex::Score> sharing(const AugmentedVector& view) const {
    return inverted_index_.query(view);
  }
  /// Standing keyframes whose cameras may be within a distance of a place (a superset), by id.
  std::vector<KeyframeId> keyframes_near(const Eigen::Vector3d& place_in_world,
                                         double distance_m) const {
    return position_index_.near(place_in_world, distance_m);
  }

  /// Pose of any keyframe ever added, through its parents if it was erased.
  SE3 camera_from_world(KeyframeId id) const;
  /// The keyframe itself if it stands, else the nearest standing one up its parents.
  KeyframeId live_keyframe(KeyframeId id) const;

  /// @throws std::logic_error naming the broken invariant.
  void check_invariants() const;
  /// xxh3-64 over everything that a map file holds of the map: equal digests, equal maps.
  std::uint64_t digest() const;

 private:
  Keyframe& mutable_at(KeyframeId id) { return keyframes_[id.value]; }
  void describe(Landmark& landmark) const;
  void set_neighbor(KeyframeId of, KeyframeId neighbor, int shared);

  std::vector<Keyframe> keyframes_;
  LandmarkTable landmarks_;
  InvertedIndex inverted_index_;
  PositionIndex position_index_;
  int keyframe_count_ = 0;
  int landmark_count_ = 0;
};

}  // namespace mh
