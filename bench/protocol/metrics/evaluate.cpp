// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/metrics/evaluate.hpp"

#include "slam/core/path_length.hpp"

namespace mh {

Evaluation evaluate(const Trajectory& truth, const Trajectory& estimate,
                    const EvaluationOptions& options) {
  const MatchedTrajectories matched = match_by_stamp(truth, estimate, options.max_difference_ns);
  Evaluation result;
  result.truth_poses = truth.size();
  result.estimate_poses = estimate.size();
  result.pairs = matched.size();
  result.truth_path_m = path_length_m(matched.truth);
  result.estimate_path_m = path_length_m(matched.estimate);
  result.alignment = options.alignment;
  result.truth_from_estimate = align(matched, options.alignment);
  if (result.truth_from_estimate) {
    const MatchedTrajectories aligned{matched.truth,
                                      transformed(*result.truth_from_estimate, matched.estimate)};
    result.ape_translation_m = error_statistics(ape_translation_m(aligned));
    result.ape_rotation_deg = error_statistics(ape_rotation_deg(aligned));
  }
  result.ape_unaligned_m = error_statistics(ape_translation_m(matched));
  for (const RpeDelta& delta : options.rpe_deltas) {
    const RelativeErrors errors = rpe(matched, delta);
    result.rpe.push_back(
        {delta, error_statistics(errors.translation_m), error_statistics(errors.rotation_deg)});
  }
  return result;
}

}  // namespace mh
