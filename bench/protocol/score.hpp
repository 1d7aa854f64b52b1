// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bench/protocol/grade.hpp"
#include "bench/protocol/metrics/query_summary.hpp"
#include "bench/protocol/query.hpp"
#include "slam/core/interpolate.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// Which mapped frame anchors a query's true pose in the map.
enum class NearestBy {
  kTime,   ///< for held-out frames: the mapped frame nearest in time
  kPlace,  ///< for another tour: the mapped frame nearest by true pose (pose_distance())
};
inline NearestBy nearest_by(QuerySet set) {
  return set == QuerySet::kHeldOut ? NearestBy::kTime : NearestBy::kPlace;
}

/// The reference from which a query's true pose in the map is computed: a mapped frame or, with
/// QueryTruth::kInterpolated, the estimate at the query's own time.
struct Anchor {
  SE3 estimate;  ///< world_from_camera of the system
  SE3 truth;     ///< true world_from_camera; the identity if unknown (interpolated)
  Stamp stamp_ns = 0;
};

/// A query's time, and the true pose of its camera if that is known.
struct QueryMoment {
  Stamp stamp_ns = 0;
  std::optional<SE3> true_world_from_camera = {};
  QueryMoment(Stamp stamp, const std::optional<SE3>& truth)
      : stamp_ns(stamp), true_world_from_camera(truth) {}
  // NOLINTNEXTLINE(google-explicit-constructor): a TimedPose holds a stamp and a pose
  QueryMoment(const TimedPose& truth) : QueryMoment(truth.stamp_ns, truth.world_from_camera) {}
};

/// Exact pose of the query camera in the system's own map: the anchor's estimated pose composed
/// with the true motion from the anchor to the query. Drift of the map elsewhere has no effect.
/// (The paper's Table 1 has distances of 0.02 m where the APE is 0.2 m, so its distances must be
/// local, too.)
SE3 local_truth(const Anchor& anchor, const SE3& true_world_from_camera);

/// Returns the anchor of a query; nullopt if nothing was mapped. Ties go to the earlier frame.
std::optional<Anchor> nearest_mapped(const Trajectory& estimate, const Trajectory& mapping_truth,
                                     const TimedPose& true_query, NearestBy by);

/// Returns a query's time and its true camera pose, interpolated from a true trajectory.
/// @param truth  null if unknown
QueryMoment moment_of(Stamp stamp_ns, const Trajectory* truth);

/// Returns the anchor that config.truth prescribes. With kInterpolated, the anchor of a held-out
/// query is the estimate interpolated at its time, which needs no truth. In all other cases, the
/// anchor is the nearest mapped frame, which needs the query's true pose: with kLocal, for queries
/// of another tour (which have no neighbors in time), and if the estimate cannot be interpolated.
std::optional<Anchor> find_anchor(const Trajectory& estimate, const Trajectory& mapping_truth,
                                  const QueryMoment& query, NearestBy by,
                                  const ProtocolConfig& config);

/// Whether a query's place is in the map: by true poses, some mapped frame is within 1 m and 30
/// degrees of the query. Absent if the query's true pose is unknown.
std::optional<bool> is_in_map(const Trajectory& estimate, const Trajectory& mapping_truth,
                              const QueryMoment& query);

/// One answer compared with the truth.
struct QueryScore {
  QueryAnswer answer;
  Stamp stamp_ns = 0;
  std::optional<SE3> true_world_from_camera = {};  ///< absent if unknown
  bool success = false;                            ///< a pose was returned (the paper's measure)
  // Both are false if the answer cannot be judged.
  bool correct = false;             ///< a pose within the protocol's limits was returned
  bool false_positive = false;      ///< a pose outside them was returned, or nothing was mapped
  std::optional<bool> in_map = {};  ///< is_in_map()
  // Absent if no pose was returned or there is no anchor: nothing was mapped, or the truth is
  // unknown. The aligned distance is also absent if the true pose is unknown, or the answer is not
  // in the map that was aligned.
  std::optional<double> distance_m = {}, angle_deg = {};  ///< to the local truth
  std::optional<double> aligned_distance_m = {};  ///< to the truth after aligning the trajectory
  QueryGrade grade = {};
};

template <MaybeConst<QueryScore> S, class Visit>
void fields(S& score, Visit& v) {
  auto& [answer, stamp_ns, true_world_from_camera, success, correct, false_positive, in_map,
         distance_m, angle_deg, aligned_distance_m, grade] = score;
  fields(answer, v);
  v("stamp_ns", stamp_ns);
  v("truth", true_world_from_camera);
  v("success", success);
  v("correct", correct);
  v("false_positive", false_positive);
  v("in_map", in_map);
  v("distance_m", distance_m);
  v("angle_deg", angle_deg);
  v("aligned_distance_m", aligned_distance_m);
  v("grade", grade);
}

/// Whether an answer can be judged: the query's true pose is known, or a distance was computed
/// without it (QueryTruth::kInterpolated).
inline bool is_judged(const QueryScore& q) {
  return q.true_world_from_camera.has_value() || q.distance_m.has_value();
}

/// @param truth_from_estimate  global SE(3) alignment of the answer's map; absent if unknown
QueryScore score(const QueryAnswer& answer, const QueryMoment& moment,
                 const std::optional<Anchor>& anchor, const std::optional<SE3>& truth_from_estimate,
                 const ProtocolConfig& config);

}  // namespace mh
