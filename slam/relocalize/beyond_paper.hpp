// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "slam/core/ids.hpp"
#include "slam/features/features.hpp"
#include "slam/map/map.hpp"
#include "slam/semantics/candidate_selection.hpp"

// Helpers of rules that use labels in ways that the paper does not. Their settings are
// `label_mass`, `candidates` and all those after `candidates` in SemanticConfig. `wider_search` is
// in candidate_trial.cpp; `label_mass` needs no helper. With every rule off, results are the
// paper's, bit for bit.

namespace mh {

/// How similar the image sizes of the same classes are in two views, in (0, 1]: near 1 if both are
/// seen from the same distance. The size of a class in a view is the root mean square distance of
/// its keypoints from their mean, px; classes with fewer than five keypoints in either view are
/// left out. The result is a mean over the shared classes: the smaller size divided by the larger,
/// weighted by the smaller number of keypoints. It is 1 if no class is shared.
double size_agreement(const Features& a, const Features& b);

/// Interleaves two lists (first of a, first of b, second of a, ...) and drops repeated keyframes.
/// Interleaving a list with itself returns it unchanged.
std::vector<Candidate<KeyframeId>> side_by_side(std::span<const Candidate<KeyframeId>> a,
                                                std::span<const Candidate<KeyframeId>> b);

/// Among the matches whose two classes are both known, the share whose classes are equal; 1 if
/// there are fewer than ten such matches.
/// @param landmarks  of each feature of the view; invalid = none
double label_agreement(const Features& view, std::span<const LandmarkId> landmarks, const Map& map);

}  // namespace mh
