// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "scenes/scene.hpp"

namespace mh {

/// Builds a furnished house from its description (scenes/model_house/house.yaml shows all keys):
/// rooms, walls, doorways, windows, furniture, materials, lights. The same file gives the same
/// scene, bit for bit.
/// @throws InputError "file:line: place: what" on an unknown key, kind, role or material, a wrong
/// type, a size that is not positive, a room outside the house, rooms that overlap, a doorway that
/// is not in a wall or is narrower than 0.6 m, a window that is not in an outer wall, furniture
/// that overlaps a wall or other furniture, or is outside all rooms.
Scene load_house(const std::filesystem::path& yaml);

/// The same from text; `name` names the file in messages.
Scene build_house(const std::string& yaml_text, const std::string& name);

/// Counts the triangles that build_house would create, without painting materials.
std::size_t count_triangles(const std::string& yaml_text, const std::string& name);

}  // namespace mh
