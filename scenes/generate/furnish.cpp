// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/furnish.hpp"

#include "scenes/generate/arrangements.hpp"
#include "scenes/generate/parts.hpp"
#include "scenes/generate/places.hpp"

namespace mh::generate {
namespace {

/// Adds a free-standing piece with its parts. @returns whether there was space for it
bool add_one(Draft& draft, const Design& design) {
  for (int t = 0; t < kTries; ++t)
    if (const auto item = put_in_room(draft, design))
      if (const auto index = add(draft, *item, design)) {
        add_parts(draft, *design.rule, *index);
        return true;
      }
  return false;
}

}  // namespace

bool add_by_rule(Draft& draft, const ItemRule& rule) {
  const bool wanted = draft.dice.chance(rule.chance);
  if (!rule.need && (!wanted || full(draft))) return true;
  const int count = draw_count(draft.dice, rule.count);
  const Design common = make_design(draft, rule);
  switch (rule.place) {
    case Place::kRows:
      return add_rows(draft, common) > 0 || !rule.need;
    case Place::kAisles:
      return add_aisles(draft, common) > 0 || !rule.need;
    case Place::kAlong:
      for (int i = 0; i < count; ++i) add_along_wall(draft, common);
      return true;
    case Place::kWindow:
      add_at_windows(draft, common);
      return true;
    case Place::kDoor:
      add_at_doors(draft, common);
      return true;
    default:
      break;
  }
  int placed = 0;
  for (int i = 0; i < count && (placed == 0 || rule.need || !full(draft)); ++i)
    placed += add_one(draft, design_of_piece(draft, common, i)) ? 1 : 0;
  return placed > 0 || !rule.need || count == 0;
}

void add_extras(Draft& draft) {
  const std::vector<ItemRule>& extras = draft.grammar.extras;
  double total = 0;
  for (const ItemRule& rule : extras) total += rule.weight;
  const int most_tries = 40 + 12 * draft.wanted_objects;
  for (int tries = 0; !full(draft) && tries < most_tries && total > 0; ++tries) {
    double at = draft.dice.number(0, total);
    std::size_t i = 0;
    while (i + 1 < extras.size() && at >= extras[i].weight) at -= extras[i++].weight;
    const ItemRule& rule = extras[i];
    const Design design = make_design(draft, rule);
    const int& there = draft.counts[std::string(design.kind->name)];
    const int count = draw_count(draft.dice, rule.count);
    for (int k = 0; k < count && !full(draft) && there < rule.most; ++k)
      add_one(draft, design_of_piece(draft, design, k));
  }
}

}  // namespace mh::generate
