// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "slam/core/trajectory.hpp"

namespace mh {

/// Largest difference of two stamps that are treated as the same time: 0.01 s, as in `evo`.
inline constexpr Stamp kMaxStampDifference_ns = 10'000'000;

/// Two trajectories of equal length: element i of one belongs to element i of the other.
struct MatchedTrajectories {
  Trajectory truth;
  Trajectory estimate;

  std::size_t size() const { return truth.size(); }
};

/// Pairs poses by stamp: each pose of the shorter trajectory (the estimate if both are equally
/// long) takes the nearest pose of the longer one (the earlier of two equally near) if it is at
/// most max_difference away. `evo` does the same, with one exception: here, if several poses claim
/// the same pose, only the nearest of them (the earliest if equally near) gets it, so that no pose
/// is counted twice.
/// @pre both ordered by strictly increasing stamp.
MatchedTrajectories match_by_stamp(const Trajectory& truth, const Trajectory& estimate,
                                   Stamp max_difference_ns = kMaxStampDifference_ns);

/// How an estimate is aligned with the truth before absolute errors are computed.
enum class Alignment {
  kNone,    ///< unchanged: both are in the same world frame
  kOrigin,  ///< first pose onto first pose
  kSe3,     ///< rotation and translation by least squares over all positions
  kSim3,    ///< rotation, translation and scale
};

/// target_from_source with scale: x -> scale * rotation * x + translation.
struct Similarity {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return scale * (rotation * point) + translation_m;
  }
  /// Scales positions; orientations are only rotated.
  SE3 operator*(const SE3& pose) const {
    return {rotation * pose.rotation(), *this * pose.translation()};
  }
};

/// argmin over target_from_source of sum |target_i - (c R source_i + t)|^2, with c = 1 unless
/// with_scale (Umeyama, "Least-squares estimation of transformation parameters between two point
/// patterns", PAMI 1991, equations 34 to 43).
/// @pre equal lengths.
/// @returns nullopt if the rotation is undetermined: fewer than three points, or all on a line.
std::optional<Similarity> umeyama(std::span<const Eigen::Vector3d> source,
                                  std::span<const Eigen::Vector3d> target, bool with_scale);

/// Returns truth_from_estimate over matched poses; nullopt if nothing was matched or umeyama() is
/// undetermined.
std::optional<Similarity> align(const MatchedTrajectories& matched, Alignment alignment);

/// Transforms every pose of a trajectory, for example to draw an estimate over the truth.
Trajectory transformed(const Similarity& target_from_source, const Trajectory& trajectory);

}  // namespace mh
