// SPDX-License-Identifier: Apache-2.0
#include "scenes/load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "scenes/gazebo.hpp"
#include "scenes/generate/generate.hpp"
#include "scenes/house.hpp"
#include "scenes/mesh_io/mesh_io.hpp"
#include "scenes/placed_objects.hpp"
#include "scenes/scannet/files.hpp"
#include "scenes/scannet/scannet.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"

namespace mh {

namespace {

Scene load(const std::filesystem::path& file, std::vector<std::string>* warnings) {
  if (file.native().starts_with(kGeneratedPrefix))
    return generate_scene(parse_generated(file.native()));
  if (is_scannet_scene(file) || is_folder(file)) return load_scannet(file, warnings);
  constexpr std::array<std::string_view, 5> kMeshes = {".dae", ".glb", ".gltf", ".obj", ".ply"};
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (std::ranges::find(kMeshes, ending) != kMeshes.end()) return load_mesh(file, warnings);
  if (ending == ".yaml" || ending == ".yml")
    return is_placed_scene(file) ? load_placed_scene(file, warnings) : load_house(file);
  if (ending == ".sdf" || ending == ".world") return load_gazebo_world(file, warnings);
  throw InputError(
      fmt::format("{}: unknown kind of scene: the ending must be .yaml, .ply, .obj, .glb, .gltf, "
                  ".dae, .sdf or .world",
                  file.string()));
}

}  // namespace

Scene load_scene(const std::filesystem::path& file, std::vector<std::string>* warnings) {
  std::vector<std::string> unheard;  // the same is looked at whether or not anybody listens
  try {
    return load(file, warnings != nullptr ? warnings : &unheard);
  } catch (const InputError& error) {
    const std::string_view what = error.what();
    if (!what.starts_with("scene ")) throw;
    throw InputError(fmt::format("{}: {}", file.string(), what));  // a scene knows no file
  }
}

}  // namespace mh
