// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/house/plan.hpp"
#include "scenes/mesh_builder.hpp"

namespace mh {

/// Builds everything but furniture: floors, walls with their openings, ceilings, baseboards, door
/// frames and doors, windows, the outer hull (so that no light leaks in), garden and lawn outside.
void build_shell(const HousePlan& house, MeshBuilder& mesh);

}  // namespace mh
