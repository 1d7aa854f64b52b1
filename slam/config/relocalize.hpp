// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/config/pose.hpp"
#include "slam/config/setting.hpp"

namespace mh {

struct RelocalizeConfig {
  int min_word_matches = 15;
  int min_inliers = 50;  ///< to accept a pose
  /// Standard deviation of a true pair's disparity error (in addition to the keypoint's own, as in
  /// Camera) before the pose is refined on the local map; never less than the camera's own. The
  /// camera's value describes a single reading. Here the landmark comes from another reading (0.1
  /// px), the pose from a handful of points (1 cm at 1.4 m: 0.2 px), color and depth are not
  /// captured at the same instant, and structured-light sensors warp (0.2 px): 0.3 px together,
  /// which is what pairs in real recordings show (docs/slam.md).
  double disparity_sigma_px = 0.3;
  RansacConfig ransac;
  friend bool operator==(const RelocalizeConfig&, const RelocalizeConfig&) = default;
};

template <Either<RelocalizeConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [min_word_matches, min_inliers, disparity_sigma_px, ransac] = c;
  v("min_word_matches", min_word_matches, setting::kPoints, "with a candidate keyframe");
  v("min_inliers", min_inliers, setting::kPoints, "to accept a pose");
  v("disparity_sigma_px", disparity_sigma_px, {0, 1000},
    "how far a true pair's depth strays; at least the camera's own");
  fields(ransac, v);
}

}  // namespace mh
