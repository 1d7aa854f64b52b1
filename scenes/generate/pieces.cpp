// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/pieces.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "scenes/generate/surfaces.hpp"

namespace mh::generate {

Design make_design(Draft& draft, const ItemRule& rule) {
  Dice& dice = draft.dice;
  Design design{&rule, find_furniture(rule.kinds[dice.below(rule.kinds.size())]), {}, {}};
  const Eigen::Vector3f& usual = design.kind->size_m;
  for (int k = 0; k < 3; ++k)
    design.size_m[k] =
        whole_mm(rule.size_m ? draw(dice, (*rule.size_m)[static_cast<std::size_t>(k)])
                             : usual[k] * dice.number(0.94, 1.06));
  design.materials = choose_materials(draft, rule, *design.kind);
  return design;
}

Design design_of_piece(Draft& draft, const Design& common, int i) {
  const bool varied =
      std::ranges::find(palettes().varied, common.kind->name) != palettes().varied.end();
  return i > 0 && varied ? make_design(draft, *common.rule) : common;
}

LayoutItem make_piece(Draft& draft, const Design& design) {
  LayoutItem piece;
  piece.kind = design.kind;
  piece.size_m = design.size_m;
  piece.materials = design.materials;
  piece.fitting = draft.fitting || design.rule->fitting;
  if (design.kind->bulb && design.kind->mount != Mount::kCeiling) {
    const double power = draft.dice.number(0.12, 0.26);
    piece.glow = Eigen::Vector3d(power, 0.82 * power, 0.56 * power);
  }
  return piece;
}

std::optional<std::size_t> add(Draft& draft, LayoutItem piece, const Design& design) {
  int& count = draft.counts[std::string(design.kind->name)];
  piece.name = fmt::format("{}_{}", design.kind->name, count + 1);
  const auto added = draft.layout.add(piece, design.rule->front_m);
  if (added) ++count;
  return added;
}

bool full(const Draft& draft) {
  return !draft.fitting && draft.layout.object_count() >= draft.wanted_objects;
}

}  // namespace mh::generate
