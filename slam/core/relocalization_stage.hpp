// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/io/words.hpp"

namespace mh {

/// Where a relocalization attempt ended: the last stage that any candidate reached and failed, or
/// kVerified.
enum class RelocalizationStage { kNone, kNoCandidate, kMatches, kPnp, kInliers, kVerified };

constexpr Names<RelocalizationStage, 6> words(RelocalizationStage) {
  return {{{"none", RelocalizationStage::kNone},
           {"no_candidate", RelocalizationStage::kNoCandidate},
           {"matches", RelocalizationStage::kMatches},
           {"pnp", RelocalizationStage::kPnp},
           {"inliers", RelocalizationStage::kInliers},
           {"verified", RelocalizationStage::kVerified}}};
}
constexpr std::string_view name(RelocalizationStage stage) {
  return name_of(stage, words(stage));
}

}  // namespace mh
