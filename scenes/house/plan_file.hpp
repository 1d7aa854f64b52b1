// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "scenes/house/plan.hpp"

namespace mh {

class YamlReader;

/// Reads and checks a description; see load_house. @throws InputError
HousePlan read_house_plan(YamlReader yaml);

/// A piece as stated on its line in the file.
struct ItemEntry {
  std::string name, kind;
  std::string on;                                  ///< the piece that carries it; empty: the floor
  Eigen::Vector2d at_m = Eigen::Vector2d::Zero();  ///< in the world, or in the carrier's frame
  double turn_deg = 0;                             ///< in the same frame
  std::optional<double> z_m;                       ///< above the floor, or above the carrier's base
  std::string under;                               ///< the piece that it is pushed under, if any
  Eigen::Vector3d size_m = Eigen::Vector3d::Ones();
  std::optional<Eigen::Vector3d> glow;           ///< lamps: linear RGB intensity at 1 m
  std::map<std::string, std::string> materials;  ///< role -> name of a material
};

struct RoomEntry {
  std::string name;
  FloorRect rect;
  std::optional<FloorRect> cut;
  std::string floor, ceiling, walls;          ///< names of materials
  std::map<Side, std::string> special_walls;  ///< walls of a different material
  std::vector<ItemEntry> items;               ///< carriers come before the pieces on them
};

struct GardenEntry {
  std::string material;
  double distance_m = 10.0, height_m = 5.0, glow = 1.0;
};

struct SunEntry {
  Eigen::Vector3d direction, color;
};

/// A house as its file describes it: materials and pieces by name, positions as written. Numbers
/// are written in whole millimeters and half degrees.
struct HouseFile {
  std::string comment;  ///< one line
  std::string name;
  FloorRect extent;
  double height_m = 2.5, wall_m = 0.1;
  std::vector<MaterialSpec> materials;
  std::vector<RoomEntry> rooms;
  std::vector<OpeningPlan> doorways, windows;  ///< with their rooms by index
  std::string trim, window_frame;              ///< names of materials
  GardenEntry garden;
  std::optional<SunEntry> sun;
  std::optional<Eigen::Vector3d> sky;  ///< its color
  std::optional<double> detail;        ///< see HousePlan::detail
};

/// Writes the text that read_house_plan reads; see docs/formats.md for the keys.
std::string to_yaml(const HouseFile& house);

}  // namespace mh
