// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <string_view>
#include <type_traits>

#include "slam/pipeline/config.hpp"

namespace mh {

/// The values that a setting may take: [min, max], or [min, max) where open.
struct SettingRange {
  double min = 0, max = 1;
  bool open = false;
};

namespace settings_detail {

template <class T, class U>
concept Either = std::same_as<std::remove_const_t<T>, U>;

inline constexpr double kMany = 1e6;
inline constexpr SettingRange kShare{0, 1}, kOpenShare{0, 1, true}, kCount{1, kMany},
    kPoints{4, kMany}, kBits{0, 256}, kGray{1, 255}, kLength_m{0, 1000}, kRadius_px{1, 1000},
    kAngle_rad{0, 3.2}, kGate{1e-3, kMany}, kSwitch{0, 1};

// Each of these names every field of one part: the brackets do not compile once a field is added
// that has no line here, so that no setting can be left out of checks, files and maps.

template <Either<FeatureConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [count, levels, scale, fast_threshold, fast_threshold_low, max_depth_m] = c;
  v("count", count, {10, 20000}, "keypoints wanted per frame");
  v("levels", levels, {1, 16}, "of the image pyramid");
  v("scale", scale, {1.01, 2}, "between levels");
  v("fast_threshold", fast_threshold, kGray, "gray levels");
  v("fast_threshold_low", fast_threshold_low, kGray, "where the first finds nothing");
  v("max_depth_m", max_depth_m, {0.1, 1000}, "depth beyond is dropped");
}

template <Either<SemanticConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [gamma, xi, alpha, beta, overlap, void_is_a_label] = c;
  v("gamma", gamma, {0, kMany}, "weight of a label, equation 1");
  v("xi", xi, {1, kMany}, "factor where labels disagree, equation 2");
  v("alpha", alpha, kOpenShare, "equation 4");
  v("beta", beta, kOpenShare, "equation 6");
  v("overlap", overlap, {}, "what equation 3 counts: labels, augmented or words");
  v("void_is_a_label", void_is_a_label, kSwitch, "void disagrees with every label");
}

template <Either<MatchConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [max_distance, max_distance_loose, ratio, ratio_projection] = c;
  v("max_distance", max_distance, kBits, "bits; appearance alone, fusion");
  v("max_distance_loose", max_distance_loose, kBits, "bits; where geometry restricts the search");
  v("ratio", ratio, kShare, "best over second best; appearance alone");
  v("ratio_projection", ratio_projection, kShare, "the same where geometry restricts the search");
}

template <Either<PoseConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [rounds, iterations, chi2_mono, chi2_stereo, min_inliers] = c;
  v("rounds", rounds, {1, 100}, "inlier sets are formed anew after each");
  v("iterations", iterations, {1, 1000}, "Gauss-Newton steps per round");
  v("chi2_mono", chi2_mono, kGate, "gate of an observation without depth");
  v("chi2_stereo", chi2_stereo, kGate, "gate of an observation with depth");
  v("min_inliers", min_inliers, kPoints, "below, there is no pose");
}

template <Either<BundleConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [iterations, refine_iterations, relative_decrease, chi2_mono, chi2_stereo] = c;
  v("iterations", iterations, {1, 1000}, "with Huber's cost, before outliers are dropped");
  v("refine_iterations", refine_iterations, {0, 1000}, "after");
  v("relative_decrease", relative_decrease, kShare, "of the cost; a smaller step ends a phase");
  v("chi2_mono", chi2_mono, kGate, "gate of an observation without depth");
  v("chi2_stereo", chi2_stereo, kGate, "gate of an observation with depth");
}

template <Either<KeyframeConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [max_interval, min_tracked_share, min_close_tracked, min_close_new, close_depth_m,
         redundant_share] = c;
  v("max_interval", max_interval, kCount, "frames after which a keyframe is wanted in any case");
  v("min_tracked_share", min_tracked_share, kShare, "of the reference keyframe's landmarks");
  v("min_close_tracked", min_close_tracked, {0, kMany}, "fewer close points tracked than this and");
  v("min_close_new", min_close_new, {0, kMany}, "more close points new than this: a keyframe");
  v("close_depth_m", close_depth_m, {0.1, 1000}, "depth makes a landmark at once up to here");
  v("redundant_share", redundant_share, kShare, "of its landmarks seen by 3 others: culled");
}

template <Either<TrackConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [min_inliers, min_inliers_sparse, min_inliers_frame, search_radius_px, local_radius_px,
         local_keyframes, near_distance_m, near_angle_rad, sure_position_m, sure_angle_rad, coast_s,
         readout_s] = c;
  v("min_inliers", min_inliers, kPoints, "after the local map, to count as tracked");
  v("min_inliers_sparse", min_inliers_sparse, kPoints,
    "where that is more than a sixth of the keypoints");
  v("min_inliers_frame", min_inliers_frame, kPoints, "after the motion model");
  v("search_radius_px", search_radius_px, kRadius_px, "around the predicted place, octave 0");
  v("local_radius_px", local_radius_px, kRadius_px, "around the place by the tracked pose");
  v("local_keyframes", local_keyframes, kCount, "at most, in the local map");
  v("near_distance_m", near_distance_m, kLength_m, "keyframes this near and");
  v("near_angle_rad", near_angle_rad, kAngle_rad, "facing this alike join the local map");
  v("sure_position_m", sure_position_m, kLength_m, "a pose less sure than this by its picture or");
  v("sure_angle_rad", sure_angle_rad, kAngle_rad, "than this is weighed against the motion");
  v("coast_s", coast_s, {0, 10}, "so long a lost camera is looked for near its last place");
  v("readout_s", readout_s, {0, 1}, "of a rolling shutter, first row to last; 0: all at once");
}

template <Either<RansacConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [max_iterations, confidence, min_inliers] = c;
  v("max_iterations", max_iterations, kCount, "of RANSAC");
  v("confidence", confidence, kOpenShare, "of RANSAC");
  v("min_pnp_inliers", min_inliers, kPoints, "of PnP");
}

template <Either<RelocalizeConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [min_word_matches, min_inliers, disparity_sigma_px, ransac] = c;
  v("min_word_matches", min_word_matches, kPoints, "with a candidate keyframe");
  v("min_inliers", min_inliers, kPoints, "to accept a pose");
  v("disparity_sigma_px", disparity_sigma_px, {0, 1000},
    "how far a true pair's depth strays; at least the camera's own");
  fields(ransac, v);
}

template <Either<LoopConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, augmented, min_gap, loosely_shared, min_similarity_share, agreeing, patience,
         same_drift_m, same_drift_rad, max_drift_m, max_drift_share, max_drift_rad, negligible_m,
         negligible_rad] = c;
  v("enabled", enabled, kSwitch, "whether loops are looked for");
  v("augmented", augmented, kSwitch, "candidates by equation 1 with labels; else by words alone");
  v("min_gap", min_gap, kCount, "keyframes between the two ends");
  v("loosely_shared", loosely_shared, kCount, "landmarks: the two ends share fewer");
  v("min_similarity_share", min_similarity_share, kShare, "of the least alike strong neighbor's");
  v("agreeing", agreeing, kCount, "keyframes that must tell of the same drift,");
  v("patience", patience, kCount, "each at most so many keyframes after the one before");
  v("same_drift_m", same_drift_m, kLength_m, "what counts as the same");
  v("same_drift_rad", same_drift_rad, kAngle_rad, "");
  v("max_drift_m", max_drift_m, kLength_m, "no loop moves the camera farther than this and");
  v("max_drift_share", max_drift_share, kShare, "this share of the way between its ends,");
  v("max_drift_rad", max_drift_rad, kAngle_rad, "nor turns it farther");
  v("negligible_m", negligible_m, kLength_m, "below, landmarks are joined but poses stay");
  v("negligible_rad", negligible_rad, kAngle_rad, "");
}

}  // namespace settings_detail

/// Calls visit.section(name) before each part of the settings and visit(name, value, range, note)
/// for each field: the one list that checks, YAML files and map files are made from.
template <settings_detail::Either<SlamConfig> C, class Visit>
void for_each_setting(C& config, Visit&& visit) {
  auto& [features, semantics, match, pose, bundle, keyframe, track, relocalize, loop] = config;
  const auto part = [&](const char* name, auto& c) {
    visit.section(name);
    settings_detail::fields(c, visit);
  };
  part("features", features);
  part("semantics", semantics);
  part("match", match);
  part("pose", pose);
  part("bundle", bundle);
  part("keyframe", keyframe);
  part("track", track);
  part("relocalize", relocalize);
  part("loop", loop);
}

}  // namespace mh
