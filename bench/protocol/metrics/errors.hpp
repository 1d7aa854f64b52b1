// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "bench/protocol/metrics/alignment.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// Statistics of a series of errors; all 0 if it is empty, so check `count` first.
struct ErrorStatistics {
  double rmse = 0;
  double mean = 0;
  double median = 0;  ///< for an even count, the mean of the middle two
  double std = 0;     ///< population: divided by n
  double min = 0;
  double max = 0;
  double sse = 0;  ///< sum of squares
  std::size_t count = 0;
};

ErrorStatistics error_statistics(std::span<const double> errors);

/// Absolute pose errors, one per matched pair, of an estimate already aligned with the truth:
/// distance of the positions (m), angle between the orientations (deg). Sturm et al., "A benchmark
/// for the evaluation of RGB-D SLAM systems", IROS 2012; definitions equal to `evo`'s.
std::vector<double> ape_translation_m(const MatchedTrajectories& aligned);
std::vector<double> ape_rotation_deg(const MatchedTrajectories& aligned);

/// The complete computation: association by stamp, alignment, statistics. `count` is 0 if nothing
/// was matched or the alignment is undetermined.
ErrorStatistics ape_translation(const Trajectory& truth, const Trajectory& estimate,
                                Alignment alignment);
ErrorStatistics ape_rotation(const Trajectory& truth, const Trajectory& estimate,
                             Alignment alignment);

enum class DeltaUnit {
  kFrames,   ///< matched poses, however far apart in time
  kMeters,   ///< length of the estimate's path between the poses
  kSeconds,  ///< by the estimate's stamps
};

/// Which pairs of poses a relative error is computed over.
struct RpeDelta {
  double value = 1;  ///< > 0; a whole number for frames
  DeltaUnit unit = DeltaUnit::kFrames;
  /// If true, every pose starts a pair. If false (frames only), each pair starts where the last one
  /// ended: 0 and delta, delta and 2 delta, ... Meters and seconds always use all pairs.
  bool all_pairs = false;
  /// For meters and seconds, a pose starts a pair only if the progress from it to some later pose
  /// differs from the delta by at most this share of the delta.
  double tolerance = 0.1;
};

/// Returns index pairs (start, end), ordered by start. For meters and seconds the end is the later
/// pose whose path length or time from the start is nearest to the delta (the earlier of two
/// equally near).
/// @throws InputError if the value is not positive or, for frames, not an integer.
std::vector<std::pair<std::size_t, std::size_t>> delta_pairs(const Trajectory& estimate,
                                                             const RpeDelta& delta);

/// Relative pose error of each pair: E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j) with truth Q and estimate P
/// (Sturm et al., equation 1); stores the norm of its translation (m) and its angle (deg). Moving a
/// trajectory as a whole by an SE(3) changes neither.
struct RelativeErrors {
  std::vector<double> translation_m;
  std::vector<double> rotation_deg;
};
RelativeErrors rpe(const MatchedTrajectories& matched, const RpeDelta& delta);

}  // namespace mh
