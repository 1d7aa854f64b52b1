// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/config/setting.hpp"

namespace mh {

struct LoopConfig {
  bool enabled = true;
  bool augmented = false;  ///< candidates by equation 1 with labels; otherwise by words alone
  int min_gap = 10;        ///< minimum number of keyframes between the two ends
  /// The ends of a loop must share fewer landmarks than this. Despite a drift of a few centimeters,
  /// they may share some by chance, but too few to correct the drift.
  int loosely_shared = 60;
  /// Minimum similarity of a candidate, as a share of the similarity of the newest keyframe's least
  /// similar strong neighbor.
  double min_similarity_share = 0.5;
  int agreeing = 2;            ///< keyframes that must agree on the same drift,
  int patience = 5;            ///< each of them at most this many keyframes after the one before
  double same_drift_m = 0.10;  ///< tolerance for "the same" drift
  double same_drift_rad = 0.05;
  /// Largest plausible drift: absolute, and as a share of the path between the ends. Anything
  /// larger is a different place that looks the same.
  double max_drift_m = 0.3, max_drift_share = 0.03;
  double max_drift_rad = 0.35;
  double negligible_m = 0.01;  ///< a smaller drift merges landmarks but does not move poses
  double negligible_rad = 0.003;
  /// Pieces of a map are joined once `joining` keyframes agree on their relative pose, over at
  /// least `joining_m` of the camera's path.
  int joining = 5;
  double joining_m = 1.5;
  /// If not 0, pieces are joined only if the camera's motion between them is known this accurately
  /// (two standard deviations), so that no look-alike place is within reach.
  double joining_within_m = 0;
  friend bool operator==(const LoopConfig&, const LoopConfig&) = default;
};

template <MaybeConst<LoopConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, augmented, min_gap, loosely_shared, min_similarity_share, agreeing, patience,
         same_drift_m, same_drift_rad, max_drift_m, max_drift_share, max_drift_rad, negligible_m,
         negligible_rad, joining, joining_m, joining_within_m] = c;
  v("enabled", enabled, setting::kSwitch, "whether loops are looked for");
  v("augmented", augmented, setting::kSwitch,
    "candidates by equation 1 with labels; otherwise by words alone");
  v("min_gap", min_gap, setting::kCount, "keyframes between the two ends, at least");
  v("loosely_shared", loosely_shared, setting::kCount,
    "the two ends share fewer landmarks than this");
  v("min_similarity_share", min_similarity_share, setting::kShare,
    "least similarity of a candidate, as a share of that of the least similar strong neighbor");
  v("agreeing", agreeing, setting::kCount, "keyframes that must agree on the drift");
  v("patience", patience, setting::kCount,
    "each of them follows the previous one by at most this many keyframes");
  v("same_drift_m", same_drift_m, setting::kLength_m,
    "drifts that differ by at most this and same_drift_rad agree");
  v("same_drift_rad", same_drift_rad, setting::kAngle_rad, "");
  v("max_drift_m", max_drift_m, setting::kLength_m, "a loop moves the camera by at most this plus");
  v("max_drift_share", max_drift_share, setting::kShare,
    "this share of the path between its ends,");
  v("max_drift_rad", max_drift_rad, setting::kAngle_rad, "and turns it by at most this");
  v("negligible_m", negligible_m, setting::kLength_m,
    "below this and negligible_rad, landmarks are joined but poses stay");
  v("negligible_rad", negligible_rad, setting::kAngle_rad, "");
  v("joining", joining, setting::kCount, "keyframes that must agree before pieces are joined,");
  v("joining_m", joining_m, setting::kLength_m, "over this length of the camera's path,");
  v("joining_within_m", joining_within_m, setting::kLength_m,
    "and only if the motion between the pieces is known this accurately (by track.max_speed_m_s), "
    "so that no look-alike place is within reach; 0: always");
}

}  // namespace mh
