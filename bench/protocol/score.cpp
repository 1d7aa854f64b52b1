// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/score.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numbers>

namespace mh {

SE3 local_truth(const Anchor& anchor, const SE3& true_world_from_camera) {
  const SE3 anchor_from_query = anchor.truth.inverse() * true_world_from_camera;
  return anchor.estimate * anchor_from_query;
}

std::optional<Anchor> nearest_mapped(const Trajectory& estimate, const Trajectory& mapping_truth,
                                     const TimedPose& true_query, NearestBy by) {
  std::optional<Anchor> best;
  double best_separation = std::numeric_limits<double>::infinity();
  for (const TimedPose& pose : estimate) {
    double s = static_cast<double>(std::abs(pose.stamp_ns - true_query.stamp_ns)) * 1e-9;
    if (by == NearestBy::kTime && s >= best_separation) continue;
    const auto truth = interpolated_pose(mapping_truth, pose.stamp_ns, kMaxTruthGap_ns);
    if (!truth) continue;
    if (by == NearestBy::kPlace) s = pose_distance(*truth, true_query.world_from_camera);
    if (s >= best_separation) continue;
    best_separation = s;
    best = Anchor{pose.world_from_camera, *truth, pose.stamp_ns};
  }
  return best;
}

QueryMoment moment_of(Stamp stamp_ns, const Trajectory* truth) {
  if (truth == nullptr) return {stamp_ns, std::nullopt};
  return {stamp_ns, interpolated_pose(*truth, stamp_ns, kMaxTruthGap_ns)};
}

std::optional<Anchor> find_anchor(const Trajectory& estimate, const Trajectory& mapping_truth,
                                  const QueryMoment& query, NearestBy by,
                                  const ProtocolConfig& config) {
  if (config.truth == QueryTruth::kInterpolated && by == NearestBy::kTime)
    if (const auto pose = interpolated_pose(estimate, query.stamp_ns))
      return Anchor{*pose, query.true_world_from_camera.value_or(SE3()), query.stamp_ns};
  if (!query.true_world_from_camera) return std::nullopt;
  return nearest_mapped(estimate, mapping_truth, {query.stamp_ns, *query.true_world_from_camera},
                        by);
}

std::optional<bool> is_in_map(const Trajectory& estimate, const Trajectory& mapping_truth,
                              const QueryMoment& query) {
  constexpr double kNear_m = 1, kNear_rad = 30 * std::numbers::pi / 180;
  if (!query.true_world_from_camera) return std::nullopt;
  const SE3& place = *query.true_world_from_camera;
  return std::ranges::any_of(estimate, [&](const TimedPose& mapped) {
    const auto truth = interpolated_pose(mapping_truth, mapped.stamp_ns, kMaxTruthGap_ns);
    return truth && (truth->translation() - place.translation()).norm() <= kNear_m &&
           angle_between_rad(*truth, place) <= kNear_rad;
  });
}

QueryScore score(const QueryAnswer& answer, const QueryMoment& moment,
                 const std::optional<Anchor>& anchor, const std::optional<SE3>& truth_from_estimate,
                 const ProtocolConfig& config) {
  QueryScore s{.answer = answer,
               .stamp_ns = moment.stamp_ns,
               .true_world_from_camera = moment.true_world_from_camera,
               .success = answer.world_from_camera.has_value()};
  if (!s.success) return s;
  const SE3& estimate = *answer.world_from_camera;
  if (anchor) {
    const SE3 truth = moment.true_world_from_camera.value_or(anchor->truth);
    if (moment.true_world_from_camera && truth_from_estimate) {
      const SE3 aligned = *truth_from_estimate * estimate;
      s.aligned_distance_m = (aligned.translation() - truth.translation()).norm();
    }
    const SE3 expected = local_truth(*anchor, truth);
    s.distance_m = (estimate.translation() - expected.translation()).norm();
    s.angle_deg = angle_between_rad(estimate, expected) * 180.0 / std::numbers::pi;
    s.correct =
        *s.distance_m <= config.correct_distance_m && *s.angle_deg <= config.correct_angle_deg;
  }
  s.false_positive = is_judged(s) && !s.correct;
  return s;
}

}  // namespace mh
