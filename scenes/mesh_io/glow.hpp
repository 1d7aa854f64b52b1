// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scenes/scene.hpp"
#include "scenes/shared_grid.hpp"

namespace mh {

/// Gives each face the mean of what its part of an emissive texture lets glow. What emits is told
/// by material, so a material that glows in parts becomes one for each brightness, of 32 steps.
/// @param glow  for each material of the scene, the texture that its emission is multiplied with;
///              empty = by one
void spread_glow(Scene& scene, const std::vector<SharedGrid<Rgb8>>& glow);

}  // namespace mh
