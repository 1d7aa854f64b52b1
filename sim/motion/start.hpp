// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "scenes/scene.hpp"
#include "sim/physics/planar_world.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

/// [x, y] in meters, within a kilometer of the origin.
Eigen::Vector2d read_place(const YamlReader& yaml);

/// Where a motion starts, as written in motion files: `start: {position: [x, y], heading_deg: h}`.
struct Start {
  Eigen::Vector2d place_m;
  double heading_rad = 0;
  int line = 0;  ///< in the file
};
Start read_start(YamlReader& motion);

/// "FILE:LINE", or "FILE" if the line is 0: the start of a message.
std::string file_and_line(const std::filesystem::path& file, int line);

/// ", since it is in no room of SCENE", or "" if it is in a room or the scene has no rooms.
std::string outside_rooms(const Scene& scene, const Eigen::Vector2d& place_m);

/// " against NAME", or "" if there is no instance. An instance that is not in the scene is a moving
/// obstacle.
std::string against(const Scene& scene, InstanceId instance);

/// @param where  file and line, for the message
/// @throws InputError if the base would stand inside something, or outside the rooms of a scene
/// that has rooms.
void check_start(PlanarWorld& world, const Scene& scene, const Eigen::Vector2d& start_m,
                 const std::string& where);

}  // namespace mh
