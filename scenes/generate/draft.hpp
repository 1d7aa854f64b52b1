// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenes/dice.hpp"
#include "scenes/generate/grammar.hpp"
#include "scenes/generate/layout.hpp"

namespace mh::generate {

/// Some stuff of a palette: what pieces of a room that are made of the same have in common.
struct Stuff {
  const PaletteEntry* entry = nullptr;
  Rgb8 tone;
  double variation = 0;
  std::vector<std::string> made;  ///< names of materials
};

/// Names of materials.
struct Surfaces {
  std::string floor, wall, ceiling, trim, frame, garden;
  std::string accent;  ///< one wall's; empty: it is as the others
  Side accent_side = Side::kSouth;
};

struct Daylight {
  bool dusk = false;
  double sun_turn_deg = 0, sun_power = 0, sky_power = 0;
};

/// One attempt at a room. The steps that furnish it draw from its dice one after the other: another
/// order is another room.
struct Draft {
  const RoomGrammar& grammar;
  Dice dice;
  int group = 0;  ///< of objects per 10 m2 of floor
  Layout layout;
  std::vector<MaterialSpec> materials = {};               ///< all that were made, used or not
  std::map<std::string, std::vector<Stuff>> stuffs = {};  ///< by palette
  Surfaces surfaces = {};
  Daylight daylight = {};
  int wanted_objects = 0;
  bool fitting = false;                    ///< what is placed now are fittings
  std::map<std::string, int> counts = {};  ///< pieces by kind
};

/// Places that are tried for one piece.
inline constexpr int kTries = 24;

/// Plans are written in whole millimeters: what is checked is what is read back.
double whole_mm(double m);
Eigen::Vector2d whole_mm(const Eigen::Vector2d& at_m);
double half_degrees(double deg);

double draw(Dice& dice, const DrawRange& range);
int draw_count(Dice& dice, const DrawRange& range);

}  // namespace mh::generate
