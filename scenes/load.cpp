// SPDX-License-Identifier: Apache-2.0
#include "scenes/load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "scenes/house.hpp"
#include "scenes/mesh_io/mesh_io.hpp"
#include "slam/core/error.hpp"

namespace mh {

Scene load_scene(const std::filesystem::path& file, std::vector<std::string>* warnings) {
  constexpr std::array<std::string_view, 5> kMeshes = {".dae", ".glb", ".gltf", ".obj", ".ply"};
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (std::ranges::find(kMeshes, ending) != kMeshes.end()) return load_mesh(file, warnings);
  if (ending == ".yaml" || ending == ".yml") return load_house(file);
  throw InputError(fmt::format(
      "{}: unknown kind of scene: the ending must be .yaml, .ply, .obj, .glb, .gltf or .dae",
      file.string()));
}

}  // namespace mh
