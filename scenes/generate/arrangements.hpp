// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/generate/pieces.hpp"

namespace mh::generate {

// Many pieces of one design, arranged in a pattern.

/// Adds rows of identical pieces that face one wall, such as desks in a classroom. @returns the
/// number of pieces
int add_rows(Draft& draft, const Design& design);
/// Adds double rows back to back, with aisles between them and around their ends, such as shelves
/// in a store.
int add_aisles(Draft& draft, const Design& design);
/// Adds curtains on both sides of each window, or one radiator or blind per window, about as wide
/// as the window.
void add_at_windows(Draft& draft, const Design& common);
/// Adds a piece on the wall next to each door, on either side.
void add_at_doors(Draft& draft, const Design& design);
/// Adds pieces of an item that runs around a room (a rail, a cable duct) along one wall, wherever
/// that wall is free.
void add_along_wall(Draft& draft, const Design& common);

}  // namespace mh::generate
