// SPDX-License-Identifier: Apache-2.0
#include "slam/pipeline/probe.hpp"

#include <cassert>

#include "slam/pipeline/locate.hpp"
#include "slam/relocalize/relocalize.hpp"

namespace mh {

Probe probe(KeyframeId candidate, const SlamState& frozen, const PreparedFrame& frame,
            RandomStream stream, const TrialGivens& givens) {
  assert(frame.words);
  const StepObservers unobserved;
  StepReport not_reported;
  const SlamContext context = context_of(frozen, unobserved, not_reported);
  const CandidateAttempt attempt =
      try_alone(candidate, without_words(frame), context, stream, givens);
  if (attempt.stage != RelocalizationStage::kVerified) return {attempt.stage, std::nullopt};
  const auto located = confirm_in_local_map(
      frame, {attempt.camera_from_world, attempt.landmarks, attempt.inliers},
      frozen.map.at(candidate).origin, frozen.config.relocalize.min_inliers, context, unobserved);
  if (!located) return {RelocalizationStage::kInliers, std::nullopt};
  return {RelocalizationStage::kVerified, located->tracked.camera_from_world.inverse()};
}

}  // namespace mh
