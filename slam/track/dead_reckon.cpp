// SPDX-License-Identifier: Apache-2.0
#include "slam/track/dead_reckon.hpp"

#include <algorithm>

#include "slam/config/slam.hpp"

namespace mh {
namespace {

bool is_sure(const Matrix6d& covariance, const TrackConfig& config) {
  const PoseSigma sigma = worst_sigma(covariance);
  return sigma.position_m <= config.sure_position_m && sigma.angle_rad <= config.sure_angle_rad;
}

}  // namespace

int points_with_depth(const Features& features) {
  return static_cast<int>(std::count_if(features.keypoints.begin(), features.keypoints.end(),
                                        [](const Keypoint& k) { return k.depth_m > 0; }));
}

void fuse_with_prediction(Located& located, const Tracker& tracker, Stamp stamp_ns,
                          const TrackConfig& config) {
  const Matrix6d covariance = located.tracked.information.inverse();
  const double elapsed_s = seconds_since_last(tracker, stamp_ns);
  if (!tracker.motion || elapsed_s <= 0) {
    located.motion = Motion::at_rest(covariance);
    return;
  }
  SE3& pose = located.tracked.camera_from_world;
  const SE3 predicted = tracker.motion->predict(tracker.last->camera_from_world, elapsed_s);
  Motion motion = tracker.motion->after(elapsed_s);
  const Vector6d off = motion.correct((pose * predicted.inverse()).log(), covariance);
  located.tracked.unsure = !is_sure(covariance, config);
  if (located.tracked.unsure) pose = SE3::exp(off) * predicted;
  located.motion = motion;
}

std::optional<Located> dead_reckon(const Tracker& tracker, Stamp stamp_ns, const Features& features,
                                   const SlamContext& context) {
  const TrackConfig& config = context.config.track;
  if (!tracker.tracking() || !tracker.motion) return std::nullopt;
  if (points_with_depth(features) < config.min_inliers) return std::nullopt;
  const double elapsed_s = seconds_since_last(tracker, stamp_ns);
  const Motion motion = tracker.motion->after(elapsed_s);
  const SE3 guess = tracker.motion->predict(tracker.last->camera_from_world, elapsed_s);
  if (!is_sure(motion.pose_covariance, config)) return std::nullopt;
  if (count_that_can_be_found(*tracker.last, guess, context.map, context.camera) >=
      config.min_inliers)
    return std::nullopt;
  Located located;
  located.tracked.camera_from_world = guess;
  located.tracked.landmarks.resize(features.size());
  located.reference = context.map.live_keyframe(tracker.reference);
  located.motion = motion;
  return located;
}

}  // namespace mh
