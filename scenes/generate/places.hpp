// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "scenes/generate/pieces.hpp"

namespace mh::generate {

/// A free-standing piece at a position that its rule allows; nullopt if there is none. Does not yet
/// check whether the piece fits there.
std::optional<LayoutItem> put_in_room(Draft& draft, const Design& design);

/// The same for a piece that belongs to another: on, next to, in front of or above it.
std::optional<LayoutItem> put_at_owner(Draft& draft, const Design& design, std::size_t owner);

}  // namespace mh::generate
