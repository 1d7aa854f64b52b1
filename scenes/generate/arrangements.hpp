// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/generate/pieces.hpp"

namespace mh::generate {

// Many pieces of one design, arranged in a pattern.

/// Rows of equal pieces that face one wall: desks in a classroom. @returns the number of pieces
int add_rows(Draft& draft, const Design& design);
/// Double rows back to back, with aisles between them and around their ends: shelves in a shop.
int add_aisles(Draft& draft, const Design& design);
/// Curtains at both sides of each window; pieces as wide as a window (radiators, blinds) once.
void add_at_windows(Draft& draft, const Design& common);
/// On the wall next to each door, on either side.
void add_at_doors(Draft& draft, const Design& design);
/// Along walls wherever they are free: items that run around a room, in pieces between the
/// furniture.
void add_along_wall(Draft& draft, const Design& common);

}  // namespace mh::generate
