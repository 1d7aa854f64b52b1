// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "slam/features/features.hpp"
#include "slam/optimize/bundle.hpp"
#include "slam/optimize/pose.hpp"

namespace mh {

/// What is counted as n in equation 3 (see DESIGN: Algorithm 1 leaves it open).
enum class Overlap { kLabels, kAugmented, kWords };

/// The paper's parameters. neutral() is the plain system.
struct SemanticConfig {
  double gamma = 1.0;  ///< weight of a label in equation 1, >= 0
  double xi = 1.5;     ///< penalty factor of equation 2, >= 1
  double alpha = 0.8;  ///< equation 4, [0, 1)
  double beta = 0.75;  ///< equation 6, [0, 1)
  Overlap overlap = Overlap::kAugmented;
  bool void_is_a_label = false;

  static SemanticConfig neutral() { return {.gamma = 0.0, .xi = 1.0, .overlap = Overlap::kWords}; }
};

struct MatchConfig {
  int max_distance = 50;        ///< bits; tight gate (tracking by appearance, fusion)
  int max_distance_loose = 100; ///< bits; where geometry already restricts the search
  double ratio = 0.75;          ///< best / second best
};

struct KeyframeConfig {
  int max_interval = 30;        ///< frames after which a keyframe is wanted in any case
  double min_tracked_share = 0.75;  ///< of the reference keyframe's landmarks
  int min_close_tracked = 100;  ///< close points tracked below this, and
  int min_close_new = 70;       ///< close points untracked above this: a keyframe is needed
  double close_depth_m = 3.5;   ///< depth is trusted to make a landmark at once
};

struct TrackConfig {
  int min_inliers = 20;         ///< after the local map, to count as tracked
  int min_inliers_frame = 10;   ///< after the motion model
  double search_radius_px = 15; ///< at octave 0
  int local_keyframes = 80;     ///< at most, in the local map
};

struct RelocalizeConfig {
  int min_word_matches = 15;
  int min_inliers = 50;         ///< to accept a pose
  int max_candidates = 20;
  RansacConfig ransac;
};

/// One SLAM run: everything that decides its result beside vocabulary and frames.
struct SlamConfig {
  FeatureConfig features;
  SemanticConfig semantics;
  MatchConfig match;
  PoseConfig pose;
  BundleConfig bundle;
  KeyframeConfig keyframe;
  TrackConfig track;
  RelocalizeConfig relocalize;
};

/// @throws std::invalid_argument naming field and value.
void validate(const SlamConfig& config);

}  // namespace mh
