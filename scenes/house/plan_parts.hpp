// SPDX-License-Identifier: Apache-2.0
// The parts of a house plan's file, each with its reader and its writer side by side. Used only by
// plan_file.cpp.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "scenes/house/plan_file.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

using Materials = std::map<std::string, MaterialSpec>;

// plan_materials.cpp
Materials read_materials(YamlReader yaml);
MaterialSpec material_by_name(const YamlReader& yaml, const Materials& materials);
Eigen::Vector3f read_light_color(const YamlReader& yaml);
std::string materials_text(std::span<const MaterialSpec> materials);

// plan_rooms.cpp
FloorRect read_rect(const YamlReader& yaml);
std::string rect_text(const FloorRect& rect);
Side side_by_name(const YamlReader& yaml);
/// Adds a room without its items.
void read_room(YamlReader& yaml, const Materials& materials, HousePlan& house);
std::size_t room_by_name(const YamlReader& yaml, const std::vector<RoomPlan>& rooms);
/// The text of a room with its items.
std::string room_text(const RoomEntry& room);

// plan_openings.cpp
void read_doorways(const YamlReader& yaml, HousePlan& house);
void read_windows(const YamlReader& yaml, HousePlan& house);
std::string doorways_text(const HouseFile& house);
std::string windows_text(const HouseFile& house);

// plan_items.cpp
/// Reads the pieces of a room and adds them to the house.
void read_items(const YamlReader& yaml, const Materials& materials, std::size_t room,
                HousePlan& house);
std::string item_text(const ItemEntry& item);

}  // namespace mh
