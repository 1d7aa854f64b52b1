// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "scenes/generate/draft.hpp"

namespace mh::generate {

/// Chooses the materials of floor, walls, ceiling, frames and the garden outside.
void choose_surfaces(Draft& draft);

/// Chooses materials for all roles of a kind of furniture: role -> name.
std::map<std::string, std::string> choose_materials(Draft& draft, const ItemRule& rule,
                                                    const FurnitureKind& kind);

}  // namespace mh::generate
