// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenes/generate/draft.hpp"

namespace mh::generate {

/// An empty room within the grammar's size range, of a size that suits a density group.
Draft draw_shape(const RoomGrammar& grammar, Dice dice, int group);

/// Adds a door somewhere in a wall. @returns whether it fits
bool add_door(Draft& draft, const WallRun& wall, const std::string& name, double width_m);
/// Adds doors. @returns whether there is at least one
bool add_doors(Draft& draft);
void add_windows(Draft& draft);

/// @pre the room has an outer wall: see Layout::close()
const WallRun& any_outer_wall(Draft& draft);

}  // namespace mh::generate
