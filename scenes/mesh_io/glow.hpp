// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scenes/scene.hpp"
#include "scenes/shared_grid.hpp"

namespace mh {

/// Gives each face the mean emission over its part of an emissive texture. Emission is a property
/// of the material, so a partly glowing material is split by brightness, in 32 steps.
/// @param glow  for each material of the scene, the texture that multiplies its emission; empty = 1
void spread_glow(Scene& scene, const std::vector<SharedGrid<Rgb8>>& glow);

}  // namespace mh
