// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bench/protocol/metrics/alignment.hpp"
#include "bench/protocol/metrics/errors.hpp"

namespace mh {

struct EvaluationOptions {
  Alignment alignment = Alignment::kSe3;
  Stamp max_difference_ns = kMaxStampDifference_ns;
  /// Default: per frame step and per second.
  std::vector<RpeDelta> rpe_deltas = {{.value = 1, .unit = DeltaUnit::kFrames},
                                      {.value = 1, .unit = DeltaUnit::kSeconds}};
};

struct RelativeScore {
  RpeDelta delta;
  ErrorStatistics translation_m;
  ErrorStatistics rotation_deg;
};

/// Everything needed to report on an estimate.
struct Evaluation {
  std::size_t truth_poses = 0;
  std::size_t estimate_poses = 0;
  std::size_t pairs = 0;  ///< matched by stamp; if 0, every statistic below has count 0
  double truth_path_m = 0, estimate_path_m = 0;  ///< through the matched poses
  Alignment alignment = Alignment::kSe3;
  /// truth_from_estimate; nullopt if it is undetermined (then ape_* have count 0).
  std::optional<Similarity> truth_from_estimate;
  ErrorStatistics ape_translation_m;  ///< its rmse is the ATE
  ErrorStatistics ape_rotation_deg;
  ErrorStatistics ape_unaligned_m;  ///< without alignment, for a shared world frame
  std::vector<RelativeScore> rpe;   ///< in the order of options.rpe_deltas
};

/// Scores an estimate against the truth. RPE pairs are chosen on the original estimate, before any
/// alignment. @throws InputError on a bad RPE delta.
Evaluation evaluate(const Trajectory& truth, const Trajectory& estimate,
                    const EvaluationOptions& options = {});

}  // namespace mh
