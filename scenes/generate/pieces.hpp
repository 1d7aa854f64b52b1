// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>

#include "scenes/generate/draft.hpp"

namespace mh::generate {

/// What the pieces of one rule have in common, unless they are of a varied kind (Palettes::varied).
struct Design {
  const ItemRule* rule = nullptr;
  const FurnitureKind* kind = nullptr;
  Eigen::Vector3d size_m;
  std::map<std::string, std::string> materials;  ///< role -> name
};

Design make_design(Draft& draft, const ItemRule& rule);
/// The design of the i-th piece of a rule: sets match, but no two images or cushions are the same.
Design design_of_piece(Draft& draft, const Design& common, int i);

/// Creates a piece without position and name.
LayoutItem make_piece(Draft& draft, const Design& design);
/// Names a piece and adds it at its position. @returns its index, nullopt if it does not fit
std::optional<std::size_t> add(Draft& draft, LayoutItem piece, const Design& design);

/// Whether the room has as many objects as the density group requires.
bool full(const Draft& draft);

}  // namespace mh::generate
