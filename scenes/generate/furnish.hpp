// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/generate/draft.hpp"

namespace mh::generate {

/// Adds the pieces of a rule. @returns false if a piece that the room needs does not fit
bool add_by_rule(Draft& draft, const ItemRule& rule);

/// Draws from the grammar's extras until the room has as many objects as wanted.
void add_extras(Draft& draft);

}  // namespace mh::generate
