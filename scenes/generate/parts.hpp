// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/generate/pieces.hpp"

namespace mh::generate {

/// Adds the pieces that belong to a piece (ItemRule::with), and in turn the pieces that belong to
/// those.
void add_parts(Draft& draft, const ItemRule& owner, std::size_t index);

}  // namespace mh::generate
