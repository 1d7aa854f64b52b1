// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/generate/draft.hpp"

namespace mh::generate {

/// An empty room of the grammar's size, of one that a density group asks for.
Draft draw_shape(const RoomGrammar& grammar, Dice dice, int group);

/// @returns whether there is a door at all
bool add_doors(Draft& draft);
void add_windows(Draft& draft);

const WallRun& any_outer_wall(Draft& draft);

}  // namespace mh::generate
