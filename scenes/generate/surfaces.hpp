// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "scenes/generate/draft.hpp"

namespace mh::generate {

/// What floor, walls, ceiling, frames and the garden outside are made of.
void choose_surfaces(Draft& draft);

/// Materials for all roles of a kind of furniture: role -> name.
std::map<std::string, std::string> choose_materials(Draft& draft, const ItemRule& rule,
                                                    const FurnitureKind& kind);

}  // namespace mh::generate
