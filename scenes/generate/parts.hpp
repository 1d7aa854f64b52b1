// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/generate/pieces.hpp"

namespace mh::generate {

/// Adds the pieces that belong to one (ItemRule::with), and in turn those that belong to these.
void add_parts(Draft& draft, const ItemRule& owner, std::size_t index);

}  // namespace mh::generate
