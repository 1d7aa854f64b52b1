// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
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
  /// The first keyframe of its piece of the map, which defines that piece's world: the relative
  /// pose of the worlds of different pieces is not known yet.
  KeyframeId origin{0};
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
  std::vector<Neighbor>
      covisible;  ///< those that share at least kMinShared landmarks, most first, then by id

  bool erased = false;
  std::optional<SE3> odom_from_camera = {};  ///< RgbdFrame::odom_from_camera
  KeyframeId parent;                         ///< an erased keyframe's pose is relative to this one
  SE3 camera_from_parent;                    ///< valid if erased
};

/// A pose in the world of one piece of the map.
struct MapPose {
  KeyframeId origin;  ///< Keyframe::origin
  SE3 camera_from_world;
};

/// Keyframes, landmarks and the observations that link them. Entities are addressed by id; erased
/// ones remain as tombstones. Invariants (check_invariants()): an observation and the keyframe's
/// landmark slot always refer to each other; nothing refers to erased entities; covisibility is
/// symmetric.
class Map {
 public:
  /// Minimum number of shared landmarks for two keyframes to be neighbors.
  static constexpr int kMinShared = 15;

  const std::vector<Keyframe>& keyframes() const { return keyframes_; }
  const LandmarkTable& landmarks() const { return landmarks_; }
  const Keyframe& at(KeyframeId id) const { return keyframes_[id.value]; }
  const Landmark& at(LandmarkId id) const { return landmarks_[id]; }
  int keyframe_count() const { return keyframe_count_; }
  int landmark_count() const { return landmark_count_; }
  bool empty() const { return keyframe_count_ == 0; }

  /// Rebuilds a map from its keyframes() and landmarks(). @pre ids are within range. @throws
  /// std::logic_error naming the invariant that they violate.
  static Map restore(std::vector<Keyframe> keyframes, std::vector<Landmark> landmarks);

  /// Adds a keyframe that has no landmarks yet and assigns its id. If its origin is not valid, it
  /// begins a new piece of the map.
  KeyframeId add(Keyframe keyframe);
  LandmarkId add_landmark(const Eigen::Vector3d& position_in_world, KeyframeId keyframe,
                          std::uint32_t feature);
  /// No effect if the keyframe already sees the landmark, or the feature already has a landmark.
  bool add_observation(LandmarkId landmark, KeyframeId keyframe, std::uint32_t feature);
  /// Also erases the landmark if it has no observation left.
  void erase_observation(LandmarkId landmark, KeyframeId keyframe);
  void erase(LandmarkId landmark);
  /// Moves the observations of `from` to `into` (a keyframe that sees both keeps its observation of
  /// `into`), then erases `from`.
  void fuse(LandmarkId from, LandmarkId into);
  /// Erases a keyframe; from then on its pose is stored relative to its best neighbor. The first
  /// keyframe of a piece cannot be erased.
  void erase(KeyframeId keyframe);
  /// Makes a piece part of another: moves its keyframes and landmarks into the other's world.
  void join(KeyframeId origin, KeyframeId into, const SE3& into_from_origin);

  void set_pose(KeyframeId id, const SE3& camera_from_world);
  void set_position(LandmarkId id, const Eigen::Vector3d& position_in_world) {
    if (Landmark* l = landmarks_.find(id)) l->position_in_world = position_in_world;
  }
  /// Replaces the word index of a live keyframe.
  void set_words(KeyframeId id, WordIndex words);
  void count_visible(LandmarkId id) {
    if (Landmark* l = landmarks_.find(id)) ++l->visible;
  }
  void count_found(LandmarkId id) {
    if (Landmark* l = landmarks_.find(id)) ++l->found;
  }

  /// Updates descriptor, label, mean direction and distance range of a landmark.
  void refresh(LandmarkId id, const FeatureConfig& config);
  /// Recounts the landmarks that this keyframe shares with others, and updates the neighbors of
  /// both.
  void update_covisibility(KeyframeId id);

  /// Live keyframes that share labels or words with a view, by id.
  std::vector<InvertedIndex::Score> sharing(const AugmentedVector& view) const {
    return inverted_index_.query(view);
  }
  /// Live keyframes whose cameras may be within a distance of a position (a superset), by id;
  /// including those of other pieces, whose positions are in other worlds.
  std::vector<KeyframeId> keyframes_near(const Eigen::Vector3d& place_in_world,
                                         double distance_m) const {
    return position_index_.near(place_in_world, distance_m);
  }

  /// Pose of any keyframe ever added, through its parents if it was erased.
  SE3 camera_from_world(KeyframeId id) const;
  /// The keyframe itself if it is live, otherwise its nearest live ancestor.
  KeyframeId live_keyframe(KeyframeId id) const;

  /// @throws std::logic_error naming the violated invariant.
  void check_invariants() const;
  /// xxh3-64 over everything that a map file stores of the map: equal digests, equal maps.
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
