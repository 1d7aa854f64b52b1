// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "scenes/generate/pieces.hpp"

namespace mh::generate {

/// A piece that stands for itself, somewhere where its rule wants it; nullopt if there is no such
/// place. Whether it can stand there is not asked yet.
std::optional<LayoutItem> put_in_room(Draft& draft, const Design& design);

/// The same for a piece that belongs to another: on, beside, before or above it.
std::optional<LayoutItem> put_at_owner(Draft& draft, const Design& design, std::size_t owner);

}  // namespace mh::generate
