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

/// Range that a number is drawn from, both ends included.
struct DrawRange {
  double low = 0, high = 0;
};

/// A choice of surface materials: one kind of material in several colors.
struct PaletteEntry {
  std::string kind;
  std::vector<Rgb8> tones;
  DrawRange variation;
};

/// Named palettes; the default palette of each role; the palettes that are drawn from anew for each
/// piece (so that no two images are the same); and the kinds of furniture whose pieces differ in
/// size and material within a rule (pieces of other kinds match).
struct Palettes {
  std::map<std::string, std::vector<PaletteEntry>> lists;
  std::map<std::string, std::string> list_of_role;
  std::vector<std::string> fresh, varied;
};

/// Where a piece is placed. The places from kOn on are for pieces that belong to another piece
/// (ItemRule::with).
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
  std::vector<std::string> kinds;  ///< one of them is drawn
  Place place = Place::kWall;
  bool need = false;     ///< an environment without it is redrawn
  double chance = 1.0;   ///< probability that the rule is tried at all
  double weight = 1.0;   ///< weight among extras
  int most = 1000;       ///< extras: maximum number of its kind in the whole room
  bool fitting = false;  ///< not counted as an object, wherever its rule appears
  DrawRange count{1, 1};
  std::optional<std::array<DrawRange, 3>> size_m;  ///< if not set, about the kind's usual size
  std::optional<DrawRange> z_m;   ///< height above the floor (on, around: above the carrier's base)
  DrawRange gap_m{0.005, 0.03};   ///< to the wall or to the piece that it belongs to
  DrawRange turn_deg{0, 0};       ///< added to the rotation that the place requires
  double front_m = 0.0;           ///< depth of the floor that must stay free in front of it
  DrawRange spacing_m{1.2, 1.5};  ///< rows and aisles: clear width between them
  std::array<double, 4> zone{-1, -1, 1, 1};      ///< of the carrier's top, x and y in units of its
                                                 ///< half size
  std::vector<std::string> carriers;             ///< kOnAny: kinds that carry it
  std::map<std::string, std::string> materials;  ///< role -> palette
  std::vector<ItemRule> with;
};

/// How one type of room is generated. A category has one or several ("misc": a gym, a garage, ...).
struct RoomGrammar {
  std::string name;
  DrawRange area_m2, aspect, height_m;
  double cut_chance = 0;           ///< probability of an L-shaped room
  DrawRange cut_share{0.25, 0.5};  ///< share of width and depth that the missing corner takes
  DrawRange windows{0, 2}, window_width_m{0.9, 1.6}, window_sill_m{0.8, 1.0},
      window_head_m{1.9, 2.2};
  DrawRange doors{1, 1};
  std::array<double, 4> density{1, 1, 1, 1};         ///< weights of the groups of objects per 10 m2
  std::vector<std::string> floors, walls, ceilings;  ///< names of palettes
  double accent_chance = 0.2;  ///< probability of one wall in a different color
  std::string lamp = "ceiling_lamp";
  double area_per_lamp_m2 = 8;
  DrawRange lamp_power{3.0, 5.0}, warmth{0.0, 1.0};
  std::map<std::string, std::string> roles;  ///< role -> palette; overrides Palettes::list_of_role
  std::vector<ItemRule> furniture, extras;
  std::vector<ItemRule> fittings;  ///< placed last and not counted as objects
};

/// How a floor of similar rooms is generated: rooms of one design on both sides of a corridor, each
/// with some objects of its own.
struct FloorGrammar {
  std::string name;
  DrawRange rooms_per_side, corridor_width_m, height_m;
  DrawRange objects_of_its_own;  ///< number per room, drawn from the room's extras
  RoomGrammar room;              ///< furniture and fittings are the same in every room
  RoomGrammar corridor;          ///< its size follows from the rooms
};

struct Category {
  std::string name;
  int count = 0;  ///< number of environments in the paper's Table 1
  std::vector<RoomGrammar> rooms;
};

/// The twelve categories in the order of the paper's Table 1. Parsed once.
const std::vector<Category>& categories();
const Palettes& palettes();
/// Floors of similar rooms, in the order of kFloorNames. Parsed once.
const std::vector<FloorGrammar>& floors();
/// The floor with that name; nullptr if there is none.
const FloorGrammar* floor_by_name(std::string_view name);
/// @throws InputError listing the known categories and floors
const Category& category_by_name(std::string_view name);

}  // namespace mh
