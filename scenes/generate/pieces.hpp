// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>

#include "scenes/generate/draft.hpp"

namespace mh::generate {

/// What the pieces of one rule have in common, unless its kind is a varied one.
struct Design {
  const ItemRule* rule = nullptr;
  const FurnitureKind* kind = nullptr;
  Eigen::Vector3d size_m;
  std::map<std::string, std::string> materials;  ///< role -> name
};

Design make_design(Draft& draft, const ItemRule& rule);
/// For the i-th piece of a rule: sets match, but no two pictures or cushions are alike.
Design design_of_piece(Draft& draft, const Design& common, int i);

/// A piece without place and name.
LayoutItem make_piece(Draft& draft, const Design& design);
/// Names a piece and adds it where it stands. @returns its index, nullopt if it cannot stand there
std::optional<std::size_t> add(Draft& draft, LayoutItem piece, const Design& design);

/// Whether there are as many objects as the density group asks for.
bool full(const Draft& draft);

}  // namespace mh::generate
