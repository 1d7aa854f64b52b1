// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/generate/draft.hpp"

namespace mh::generate {

/// Lamps at the ceiling, in rows, and in the arms of an L-shaped room. @returns whether one hangs
bool add_lamps(Draft& draft);

Daylight draw_daylight(Dice& dice);

}  // namespace mh::generate
