// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "slam/core/loop_closure.hpp"
#include "slam/core/match_counts.hpp"
#include "slam/core/relocalization_stage.hpp"
#include "slam/core/se3.hpp"
#include "slam/core/track_status.hpp"
#include "slam/io/fields.hpp"

namespace mh {

/// Keyframes left after each step of Algorithm 1, if the system reports them.
struct Candidates {
  std::optional<int> keyframes;      ///< in the map
  std::optional<int> c1, c2, c3;     ///< after equations 3, 4 and 5
  std::optional<int> final;          ///< after equation 6
  std::optional<double> label_mass;  ///< share of the query vector's L1 mass held by labels
  std::optional<double> gamma;       ///< the weight of a label that resulted in this share
  /// Among the similarities in equation 5: the share that no query computed (unscored) and the
  /// share left over from earlier queries (stale); the stale similarities' share of the sums, and
  /// their mean age in queries.
  std::optional<double> unscored{}, stale{}, stale_weight{}, stale_age{};
  friend bool operator==(const Candidates&, const Candidates&) = default;
};

template <MaybeConst<Candidates> C, class Visit>
void fields(C& candidates, Visit& v) {
  auto& [keyframes, c1, c2, c3, final, label_mass, gamma, unscored, stale, stale_weight,
         stale_age] = candidates;
  v("keyframes", keyframes);
  v("c1", c1);
  v("c2", c2);
  v("c3", c3);
  v("final", final);
  v("label_mass", label_mass);
  v("gamma", gamma);
  v("unscored", unscored);
  v("stale", stale);
  v("stale_weight", stale_weight);
  v("stale_age", stale_age);
}

/// A system's report on one frame. What it does not report is absent.
struct SystemReport {
  TrackStatus status = TrackStatus::kLost;
  std::optional<SE3> world_from_camera;  ///< in the system's own world
  std::uint32_t map = 0;  ///< the map that the pose refers to, if the system keeps several
  std::optional<int> keypoints, inliers;
  bool keyframe_added = false;
  bool map_reset = false;  ///< it discarded its map and started a new one: earlier poses are void
  std::optional<LoopClosure> loop;  ///< the loop that was closed, if any
  std::optional<RelocalizationStage> relocalization;
  Candidates candidates;  ///< set when relocalization was tried
  std::optional<MatchCounts> matches;
};

/// Digest of everything in a report about matching and relocalization, except the pose.
std::uint64_t digest_of_matching(const SystemReport& report);

}  // namespace mh
