// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "slam/pipeline/prepared_frame.hpp"
#include "slam/relocalize/candidate_trial.hpp"

namespace mh {

/// What localize() would answer to a lost frame if one keyframe were its only candidate.
struct Probe {
  RelocalizationStage stage = RelocalizationStage::kNone;  ///< as in relocalize()
  std::optional<SE3> world_from_camera;
};

/// Tries one keyframe for a lost frame, and refines the resulting pose in the local map.
/// @param frame  its words must have been computed
/// @param stream  that of localize(): with the same draws, the winner among localize()'s candidates
///                gives a bit-identical answer when tried alone
/// @param givens affects the trial, not the refinement
Probe probe(KeyframeId candidate, const SlamState& frozen, const PreparedFrame& frame,
            RandomStream stream, const TrialGivens& givens = {});

}  // namespace mh
