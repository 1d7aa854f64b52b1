// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/generate/draft.hpp"

namespace mh::generate {

/// Adds what a rule asks for. @returns false if something that the room needs has no place
bool add_by_rule(Draft& draft, const ItemRule& rule);

/// Draws among the grammar's extras until there are as many objects as wanted.
void add_extras(Draft& draft);

}  // namespace mh::generate
