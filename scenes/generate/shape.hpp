// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/generate/draft.hpp"

namespace mh::generate {

/// An empty room of the grammar's size range, of a size suited to a density group.
Draft draw_shape(const RoomGrammar& grammar, Dice dice, int group);

/// Adds doors. @returns whether there is at least one
bool add_doors(Draft& draft);
void add_windows(Draft& draft);

const WallRun& any_outer_wall(Draft& draft);

}  // namespace mh::generate
