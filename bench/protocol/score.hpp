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

/// Where the query camera is in the system's own map by the paper's estimate: between its
/// neighbors in time among the mapped frames, position linearly, rotation along the shortest turn.
/// nullopt if one of them is missing or they lie more than kMaxNeighborGap_ns apart.
std::optional<SE3> interpolated_pose(const Trajectory& estimate, Stamp stamp_ns);

/// The anchor that config.truth asks for. Interpolation is for held-out frames: a query found by
/// place has no neighbors in time, and is compared as by kLocal.
std::optional<Anchor> find_anchor(const Trajectory& estimate, const Trajectory& mapping_truth,
                                  const TimedPose& true_query, NearestBy by,
                                  const ProtocolConfig& config);

/// One answer beside the truth.
struct QueryScore {
  QueryAnswer answer;
  Stamp stamp_ns = 0;
  SE3 true_world_from_camera;
  bool success = false;  ///< a pose was returned (the paper's measure)
  bool correct = false;  ///< and lies within the limits of the protocol
  bool wrong = false;    ///< returned, and outside them (or nothing to compare with)
  // Absent where nothing was answered, or nothing was mapped that an answer may be compared with.
  std::optional<double> distance_m = {}, angle_deg = {};  ///< to the local truth
  std::optional<double> aligned_distance_m = {};  ///< to the truth after aligning the trajectory
};

/// @param truth_from_estimate  global SE(3) alignment of the mapping trajectory
QueryScore score(const QueryAnswer& answer, const TimedPose& truth,
                 const std::optional<Anchor>& anchor, const SE3& truth_from_estimate,
                 const ProtocolConfig& config);

}  // namespace mh
