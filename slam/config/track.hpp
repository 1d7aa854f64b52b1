// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/config/setting.hpp"

namespace mh {

struct TrackConfig {
  int min_inliers = 20;          ///< inliers in the local map that make a frame count as tracked
  int min_inliers_sparse = 10;   ///< if a sixth of the keypoints is fewer than min_inliers, that
                                 ///< sixth is enough, but at least this
  int min_inliers_frame = 8;     ///< inliers needed before the local map is searched
  double search_radius_px = 15;  ///< around the predicted position, at octave 0
  double local_radius_px = 5;  ///< around the position predicted from the tracked pose, at octave 0
  int local_keyframes = 60;    ///< maximum number in the local map
  double near_distance_m = 2.5;  ///< keyframes within this distance join the local map,
  double near_angle_rad =
      0.9;  ///< if they face the same way to within this angle, even without shared landmarks
  double sure_position_m =
      0.015;  ///< if the standard deviation of a pose from the image alone is above this
  double sure_angle_rad = 0.01;  ///< or this, the pose is fused with the predicted motion
  /// A frame whose image gives no pose is placed by wheel odometry or an inertial sensor, if
  /// available, up to this drift (one standard deviation).
  double reckon_position_m = 0.3;
  double reckon_angle_rad = 0.2;
  /// While mapping, a pose is accepted only if the camera can have reached it from its previous
  /// pose at this speed; 0: no limit.
  double max_speed_m_s = 0;
  /// After a rewind, a frame that was tracked before is searched for at its earlier pose.
  bool earlier_poses = false;
  /// While mapping, a camera that has been lost for this long begins a new piece of the map; 0:
  /// never. LoopConfig::joining states when pieces are joined.
  double new_piece_after_s = 0;
  double coast_s = 1.0;  ///< how long a lost camera is searched for along its predicted motion
  /// Time that a rolling shutter takes from the first row to the last; the stamp is that of the
  /// middle row. 0: global shutter.
  double readout_s = 0;
  friend bool operator==(const TrackConfig&, const TrackConfig&) = default;
};

template <MaybeConst<TrackConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [min_inliers, min_inliers_sparse, min_inliers_frame, search_radius_px, local_radius_px,
         local_keyframes, near_distance_m, near_angle_rad, sure_position_m, sure_angle_rad,
         reckon_position_m, reckon_angle_rad, max_speed_m_s, earlier_poses, new_piece_after_s,
         coast_s, readout_s] = c;
  v("min_inliers", min_inliers, setting::kPoints,
    "inliers in the local map that make a frame count as tracked");
  v("min_inliers_sparse", min_inliers_sparse, setting::kPoints,
    "lower limit if a sixth of the keypoints is fewer than min_inliers");
  v("min_inliers_frame", min_inliers_frame, setting::kPoints,
    "inliers needed before the local map is searched");
  v("search_radius_px", search_radius_px, setting::kRadius_px,
    "around the predicted position, at octave 0");
  v("local_radius_px", local_radius_px, setting::kRadius_px,
    "around the position predicted from the tracked pose, at octave 0");
  v("local_keyframes", local_keyframes, setting::kCount, "keyframes in the local map, at most");
  v("near_distance_m", near_distance_m, setting::kLength_m, "keyframes within this distance that");
  v("near_angle_rad", near_angle_rad, setting::kAngle_rad,
    "face the same way to within this angle join the local map");
  v("sure_position_m", sure_position_m, setting::kLength_m,
    "if the image alone leaves a pose a standard deviation above this or");
  v("sure_angle_rad", sure_angle_rad, setting::kAngle_rad,
    "this, the pose is fused with the predicted motion");
  v("reckon_position_m", reckon_position_m, {0, 10},
    "if the image gives no pose, odometry or IMU place the frame, up to this drift (0: never) and");
  v("reckon_angle_rad", reckon_angle_rad, setting::kAngle_rad, "this angle of drift");
  v("max_speed_m_s", max_speed_m_s, {0, 100},
    "while mapping, a pose is accepted only if the camera can have reached it at this speed; 0: no "
    "limit");
  v("earlier_poses", earlier_poses, setting::kSwitch,
    "after a rewind, a frame is first searched for at its earlier pose");
  v("new_piece_after_s", new_piece_after_s, {0, 1000},
    "while mapping, a camera lost for this long begins a new piece of the map; 0: never");
  v("coast_s", coast_s, {0, 10},
    "how long a lost camera is searched for along its predicted motion");
  v("readout_s", readout_s, {0, 1},
    "of a rolling shutter, from the first row to the last; 0: global shutter");
}

}  // namespace mh
