// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenes/dice.hpp"
#include "scenes/generate/grammar.hpp"
#include "scenes/generate/layout.hpp"

namespace mh::generate {

/// A material drawn from a palette, shared by the matching parts of a room.
struct Stuff {
  const PaletteEntry* entry = nullptr;
  Rgb8 tone;
  double variation = 0;
  std::vector<std::string> made;  ///< names of materials
};

/// Names of materials.
struct Surfaces {
  std::string floor, wall, ceiling, trim, frame, garden;
  std::string accent;  ///< of one wall; if empty, that wall is like the others
  Side accent_side = Side::kSouth;
};

struct Daylight {
  bool dusk = false;
  double sun_turn_deg = 0, sun_power = 0, sky_power = 0;
};

/// One attempt at a room. The furnishing steps draw from its dice in sequence: a different order
/// gives a different room.
struct Draft {
  const RoomGrammar& grammar;
  Dice dice;
  int group = 0;  ///< density group: objects per 10 m2 of floor
  Layout layout;
  std::vector<MaterialSpec> materials = {};               ///< all that were created, used or not
  std::map<std::string, std::vector<Stuff>> stuffs = {};  ///< by palette
  Surfaces surfaces = {};
  Daylight daylight = {};
  int wanted_objects = 0;
  bool fitting = false;                    ///< pieces being placed are fittings
  std::map<std::string, int> counts = {};  ///< pieces by kind
};

/// Number of positions tried for one piece.
inline constexpr int kTries = 24;

/// Rounds to a millimeter. Plans are written in whole millimeters: after rounding, the positions
/// that are checked are those that will be read back.
double whole_mm(double m);
Eigen::Vector2d whole_mm(const Eigen::Vector2d& at_m);
double half_degrees(double deg);

double draw(Dice& dice, const DrawRange& range);
int draw_count(Dice& dice, const DrawRange& range);

}  // namespace mh::generate
