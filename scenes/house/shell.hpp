// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/house/plan.hpp"
#include "scenes/mesh_builder.hpp"

namespace mh {

/// Builds what is not furniture: floors, walls with their holes, ceilings, skirting, door frames
/// and doors, windows, the outer hull (so that no light leaks in), garden and lawn outside.
void build_shell(const HousePlan& house, MeshBuilder& mesh);

}  // namespace mh
