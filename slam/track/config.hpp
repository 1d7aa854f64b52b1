// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/map/keyframe_config.hpp"

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
};

}  // namespace mh
