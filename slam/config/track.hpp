// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/config/setting.hpp"

namespace mh {

struct TrackConfig {
  int min_inliers = 20;            ///< after the local map, to count as tracked
  int min_inliers_sparse = 10;     ///< the same where that is more than a sixth of the keypoints
  int min_inliers_frame = 8;       ///< after the motion model
  double search_radius_px = 15;    ///< around the predicted place, at octave 0
  double local_radius_px = 5;      ///< around the place by the tracked pose, at octave 0
  int local_keyframes = 60;        ///< at most, in the local map
  double near_distance_m = 2.5;    ///< keyframes this near and
  double near_angle_rad = 0.9;     ///< facing this alike join the local map, whatever they share
  double sure_position_m = 0.015;  ///< a pose less sure than this (one standard deviation) or
  double sure_angle_rad = 0.01;    ///< than this by its picture alone is weighed against the motion
  double coast_s = 1.0;  ///< a lost camera is looked for so long where its motion would take it
  /// From the first row to the last of a rolling shutter, whose middle row is of the stamp; 0: all
  /// rows are.
  double readout_s = 0;
  friend bool operator==(const TrackConfig&, const TrackConfig&) = default;
};

template <Either<TrackConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [min_inliers, min_inliers_sparse, min_inliers_frame, search_radius_px, local_radius_px,
         local_keyframes, near_distance_m, near_angle_rad, sure_position_m, sure_angle_rad, coast_s,
         readout_s] = c;
  v("min_inliers", min_inliers, setting::kPoints, "after the local map, to count as tracked");
  v("min_inliers_sparse", min_inliers_sparse, setting::kPoints,
    "where that is more than a sixth of the keypoints");
  v("min_inliers_frame", min_inliers_frame, setting::kPoints, "after the motion model");
  v("search_radius_px", search_radius_px, setting::kRadius_px,
    "around the predicted place, octave 0");
  v("local_radius_px", local_radius_px, setting::kRadius_px,
    "around the place by the tracked pose");
  v("local_keyframes", local_keyframes, setting::kCount, "at most, in the local map");
  v("near_distance_m", near_distance_m, setting::kLength_m, "keyframes this near and");
  v("near_angle_rad", near_angle_rad, setting::kAngle_rad, "facing this alike join the local map");
  v("sure_position_m", sure_position_m, setting::kLength_m,
    "a pose less sure than this by its picture or");
  v("sure_angle_rad", sure_angle_rad, setting::kAngle_rad,
    "than this is weighed against the motion");
  v("coast_s", coast_s, {0, 10}, "so long a lost camera is looked for near its last place");
  v("readout_s", readout_s, {0, 1}, "of a rolling shutter, first row to last; 0: all at once");
}

}  // namespace mh
