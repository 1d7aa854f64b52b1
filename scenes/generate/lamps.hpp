// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/generate/draft.hpp"

namespace mh::generate {

/// Hangs lamps from the ceiling, in rows, also in the arms of an L-shaped room. @returns whether
/// any lamp fits
bool add_lamps(Draft& draft);

Daylight draw_daylight(Dice& dice);

}  // namespace mh::generate
