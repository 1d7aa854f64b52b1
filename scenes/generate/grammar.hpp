// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/materials/materials.hpp"

namespace mh {

/// What a number is drawn from, both ends included.
struct DrawRange {
  double low = 0, high = 0;
};

/// Stuff that surfaces may be made of: one kind of material in some colors.
struct PaletteEntry {
  std::string kind;
  std::vector<Rgb8> tones;
  DrawRange variation;
};

/// Named lists of stuff, which list a part of furniture is made from where nothing else is said,
/// the lists that are drawn from anew for each piece (pictures: no two alike), and the kinds of
/// furniture of which a rule's pieces differ in size and stuff, where those of others are a set.
struct Palettes {
  std::map<std::string, std::vector<PaletteEntry>> lists;
  std::map<std::string, std::string> list_of_role;
  std::vector<std::string> fresh, varied;
};

/// Where a piece is put. The second row is of pieces that belong to another (ItemRule::with).
enum class Place {
  kWall,
  kCorner,
  kCenter,
  kFloor,
  kHang,
  kAlong,
  kRows,
  kAisles,
  kWindow,
  kDoor,
  kCeiling,
  kOnAny,
  kOn,
  kBeside,
  kFront,
  kAround,
  kAbove
};

struct ItemRule {
  std::vector<std::string> kinds;  ///< one is drawn
  Place place = Place::kWall;
  bool need = false;     ///< an environment without it is drawn anew
  double chance = 1.0;   ///< of being tried at all
  double weight = 1.0;   ///< among extras
  int most = 1000;       ///< extras: pieces of its kind in the whole room
  bool fitting = false;  ///< is no object of its own, wherever its rule stands
  DrawRange count{1, 1};
  std::optional<std::array<DrawRange, 3>> size_m;  ///< none: the kind's usual size, nearly
  std::optional<DrawRange> z_m;   ///< height above floor (on, around: the carrier's foot)
  DrawRange gap_m{0.005, 0.03};   ///< to the wall or to the piece that it belongs to
  DrawRange turn_deg{0, 0};       ///< added to the turn that the place asks for
  double front_m = 0.0;           ///< floor that must stay free before it
  DrawRange spacing_m{1.2, 1.5};  ///< rows and aisles: free way between them
  std::array<double, 4> zone{-1, -1, 1, 1};      ///< of the carrier's top, x and y in half sizes
  std::vector<std::string> carriers;             ///< kOnAny: kinds that carry it
  std::map<std::string, std::string> materials;  ///< role -> palette
  std::vector<ItemRule> with;
};

/// How one sort of room is made. A category has one or several ("misc": a gym, a garage, ...).
struct RoomGrammar {
  std::string name;
  DrawRange area_m2, aspect, height_m;
  double cut_chance = 0;           ///< of an L-shaped room
  DrawRange cut_share{0.25, 0.5};  ///< of width and depth that the missing corner takes
  DrawRange windows{0, 2}, window_width_m{0.9, 1.6}, window_sill_m{0.8, 1.0},
      window_head_m{1.9, 2.2};
  DrawRange doors{1, 1};
  std::array<double, 4> density{1, 1, 1, 1};         ///< weights of the groups of objects per 10 m2
  std::vector<std::string> floors, walls, ceilings;  ///< names of palettes
  double accent_chance = 0.2;                        ///< of one wall of another color
  std::string lamp = "ceiling_lamp";
  double area_per_lamp_m2 = 8;
  DrawRange lamp_power{3.0, 5.0}, warmth{0.0, 1.0};
  std::map<std::string, std::string> roles;  ///< role -> palette, before Palettes::list_of_role
  std::vector<ItemRule> furniture, extras;
  std::vector<ItemRule> fittings;  ///< come last and are not counted as objects
};

struct Category {
  std::string name;
  int count = 0;  ///< environments in the paper's Table 1
  std::vector<RoomGrammar> rooms;
};

/// The twelve categories in the order of the paper's Table 1. Read once.
const std::vector<Category>& categories();
const Palettes& palettes();
/// @throws InputError naming the categories there are
const Category& category_by_name(std::string_view name);

}  // namespace mh
