// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bench/protocol/query.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// Which mapped frame vouches for a query's true place in the map.
enum class NearestBy {
  kTime,   ///< held-out frames: the mapped frame next in time
  kPlace,  ///< another tour: the mapped frame that really was nearest, 1 rad counting as 1 m
};

/// The mapped frame, by index into `truth` (the mapping sequence) and its estimate.
struct Anchor {
  SE3 estimate;  ///< world_from_camera of the system
  SE3 truth;     ///< world_from_camera, really
  Stamp stamp_ns = 0;
};

/// A query's moment, and where its camera really was: absent where nobody knows.
struct QueryMoment {
  Stamp stamp_ns = 0;
  std::optional<SE3> true_world_from_camera = {};
  QueryMoment(Stamp stamp, const std::optional<SE3>& truth)
      : stamp_ns(stamp), true_world_from_camera(truth) {}
  // NOLINTNEXTLINE(google-explicit-constructor): a pose of the truth is a query's whole moment
  QueryMoment(const TimedPose& truth) : QueryMoment(truth.stamp_ns, truth.world_from_camera) {}
};

/// Where the query camera is in the system's own map, exactly: the anchor's estimated pose
/// composed with the true motion from the anchor to the query. Drift of the map elsewhere does not
/// count (the paper's 0.02 m beside an APE of 0.2 m shows that its distance was local too).
SE3 local_truth(const Anchor& anchor, const SE3& true_world_from_camera);

/// The anchor of a query; nullopt where nothing was mapped. Ties go to the earlier frame.
std::optional<Anchor> nearest_mapped(const Trajectory& estimate, const Trajectory& mapping_truth,
                                     const TimedPose& true_query, NearestBy by);

/// Neighbors in time that a pose may be interpolated between lie at most this far apart: held-out
/// frames miss one frame or two, and beyond that an interpolation says nothing.
inline constexpr Stamp kMaxNeighborGap_ns = 500'000'000;

/// Likewise for the truth, which a recording may tell at other moments than its frames'. Over this
/// gap g a hand that accelerates by 5 m/s2 and 10 rad/s2 leaves the interpolation by a g^2 / 8: 1.6
/// mm and 0.2 degrees. It is less than two frames at 30 Hz, so that a frame whose own pose is
/// invalid gets none of its neighbors'.
inline constexpr Stamp kMaxTruthGap_ns = 50'000'000;

/// The pose at a moment: the one of that stamp, else between its neighbors in time, position
/// linearly, rotation along the shortest turn. Of mapped frames it is where the query camera is in
/// the system's own map by the paper's estimate.
/// nullopt if a neighbor is missing or they lie more than max_gap_ns apart.
std::optional<SE3> interpolated_pose(const Trajectory& trajectory, Stamp stamp_ns,
                                     Stamp max_gap_ns = kMaxNeighborGap_ns);

/// Where the camera of a query was, as a trajectory of the truth tells it.
/// @param truth  may be null: nobody knows
QueryMoment moment_of(Stamp stamp_ns, const Trajectory* truth);

/// The anchor that config.truth asks for. Interpolation is for held-out frames: a query found by
/// place has no neighbors in time, and is compared as by kLocal. It alone needs no truth.
std::optional<Anchor> find_anchor(const Trajectory& estimate, const Trajectory& mapping_truth,
                                  const QueryMoment& query, NearestBy by,
                                  const ProtocolConfig& config);

/// One answer beside the truth.
struct QueryScore {
  QueryAnswer answer;
  Stamp stamp_ns = 0;
  std::optional<SE3> true_world_from_camera = {};  ///< absent where nobody knows
  bool success = false;                            ///< a pose was returned (the paper's measure)
  // Both false where the answer cannot be judged.
  bool correct = false;  ///< and lies within the limits of the protocol
  bool false_positive =
      false;  ///< returned, and outside them (or nothing was mapped to compare with)
  // Absent where nothing was answered, or nothing was mapped that an answer may be compared with.
  std::optional<double> distance_m = {}, angle_deg = {};  ///< to the local truth
  std::optional<double> aligned_distance_m = {};  ///< to the truth after aligning the trajectory
};

template <Either<QueryScore> S, class Visit>
void fields(S& score, Visit& v) {
  auto& [answer, stamp_ns, true_world_from_camera, success, correct, false_positive, distance_m,
         angle_deg, aligned_distance_m] = score;
  fields(answer, v);
  v("stamp_ns", stamp_ns);
  v("truth", true_world_from_camera);
  v("success", success);
  v("correct", correct);
  v("false_positive", false_positive);
  v("distance_m", distance_m);
  v("angle_deg", angle_deg);
  v("aligned_distance_m", aligned_distance_m);
}

/// Whether it is known if an answer was correct: there is a truth, or a distance without one
/// (QueryTruth::kInterpolated).
inline bool is_judged(const QueryScore& q) {
  return q.true_world_from_camera.has_value() || q.distance_m.has_value();
}

/// @param truth_from_estimate  global SE(3) alignment of the mapping trajectory
QueryScore score(const QueryAnswer& answer, const QueryMoment& moment,
                 const std::optional<Anchor>& anchor, const SE3& truth_from_estimate,
                 const ProtocolConfig& config);

}  // namespace mh
