// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "slam/config/pose.hpp"
#include "slam/config/setting.hpp"

namespace mh {

/// What it takes to accept a candidate keyframe's pose.
enum class Acceptance {
  kOurs,     ///< guided searches follow any consensus of at least ransac.min_inliers, however small
  kOrbSlam2  ///< by ORB-SLAM2's rules (Mur-Artal and Tardos 2017): see candidate_trial.hpp
};
constexpr std::array<std::pair<std::string_view, Acceptance>, 2> words(Acceptance) {
  return {{{"ours", Acceptance::kOurs}, {"orb_slam2", Acceptance::kOrbSlam2}}};
}

/// The similarity, in equation 5, of a neighbor that shares words with the query but fails equation
/// 4.
enum class NeighborScores {
  kFresh,      ///< computed for this query
  kCleared,    ///< 0, as if ORB-SLAM2's mRelocScore were cleared before each query
  kAsReleased  ///< what an earlier query left, or 0, as in ORB-SLAM2's mRelocScore as released.
               ///< Replies then depend on the order of the queries.
};
constexpr std::array<std::pair<std::string_view, NeighborScores>, 3> words(NeighborScores) {
  return {{{"fresh", NeighborScores::kFresh},
           {"cleared", NeighborScores::kCleared},
           {"as_released", NeighborScores::kAsReleased}}};
}

struct RelocalizeConfig {
  Acceptance acceptance = Acceptance::kOurs;
  NeighborScores neighbor_scores = NeighborScores::kFresh;
  int min_word_matches = 15;
  int min_inliers = 50;    ///< to accept a pose
  double rival_share = 0;  ///< a pose is refused if a rival elsewhere has at least this share of
                           ///< its inliers; 0: the first pose is taken
  /// Radius of the first guided search, around the position at which a pose from few matches
  /// predicts a landmark; the second search uses 4 px.
  double search_radius_px = 10;
  /// Standard deviation of a correct match's disparity error at octave 0 (as in Camera), used until
  /// the pose is refined against the local map; the camera's own value is used if it is larger. The
  /// camera's value describes a single reading. Here, in addition, the landmark comes from another
  /// reading (0.1 px), the pose from a handful of points (1 cm at 1.4 m: 0.2 px), color and depth
  /// are not captured at the same instant, and structured-light sensors warp depth (0.2 px).
  /// Together, these give 0.3 px, as matches in real recordings do (docs/slam.md).
  double disparity_sigma_px = 0.3;
  RansacConfig ransac;
  friend bool operator==(const RelocalizeConfig&, const RelocalizeConfig&) = default;
};

template <MaybeConst<RelocalizeConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [acceptance, neighbor_scores, min_word_matches, min_inliers, rival_share, search_radius_px,
         disparity_sigma_px, ransac] = c;
  v("acceptance", acceptance, {},
    "by which rules a candidate's pose is accepted: ours or orb_slam2");
  v("neighbor_scores", neighbor_scores, {},
    "scores of neighbors in equation 5: fresh, cleared or as_released (as in ORB-SLAM2)");
  v("min_word_matches", min_word_matches, setting::kPoints,
    "matches by words that a candidate keyframe needs");
  v("min_inliers", min_inliers, setting::kPoints, "inliers needed to accept a pose");
  v("rival_share", rival_share, setting::kShare,
    "a pose is rejected if another one elsewhere has this share of its inliers; 0: the first pose "
    "is taken");
  v("search_radius_px", search_radius_px, setting::kRadius_px,
    "of the first search by pose (acceptance: ours)");
  v("disparity_sigma_px", disparity_sigma_px, {0, 1000},
    "standard deviation of a true pair's disparity error; at least the camera's own");
  fields(ransac, v);
}

}  // namespace mh
