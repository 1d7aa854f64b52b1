// SPDX-License-Identifier: Apache-2.0
#include "scenes/load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "scenes/floor.hpp"
#include "scenes/gazebo.hpp"
#include "scenes/generate/generate.hpp"
#include "scenes/house/house.hpp"
#include "scenes/mesh_io/mesh_io.hpp"
#include "scenes/placed_objects.hpp"
#include "scenes/scannet/files.hpp"
#include "scenes/scannet/scannet.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/lower_case.hpp"
#include "slam/io/printable.hpp"

namespace mh {

namespace {

/// A house is z-up, with its floor at z = 0 unless `frame` states another height.
Scene built(Scene house, const std::filesystem::path& file, const SceneFrame& frame) {
  if (frame.up == UpAxis::kY)
    throw InputError(fmt::format("{}: up: y: a house is built with z up", file.string()));
  if (frame.floor_z_m) house.floor.middle_m.z() = *frame.floor_z_m;
  return house;
}

/// Adds what files from other sources lack: a floor, and a room if there is none.
Scene settled(Scene scene, const SceneFrame& frame, std::vector<std::string>* warnings) {
  if (const auto found = find_floor(scene, frame.floor_z_m, warnings)) {
    scene.floor = found->floor;
    if (scene.rooms.empty() && *scene.floor.area_m2 > 0) scene.rooms.push_back(found->room);
    end_rooms_near_things(scene.rooms, found->things_m);
  } else if (!scene.positions_m.empty()) {  // nowhere to stand: the lowest point is the floor
    const auto z = [](const Eigen::Vector3f& p) { return p.z(); };
    scene.floor.middle_m.z() = static_cast<double>(std::ranges::min(scene.positions_m, {}, z).z());
    scene.floor.area_m2 = 0;
  }
  return scene;
}

Scene turned(Scene scene, const SceneFrame& frame) {
  if (frame.up == UpAxis::kY) turn_y_up(scene);
  return scene;
}

void make_legible(std::string& text) {
  if (!is_legible(text)) text = printable(std::move(text));
}

/// Names from files are printed and written into JSON, so they must be legible.
void make_legible(Scene& scene) {
  make_legible(scene.name);
  for (Instance& instance : scene.instances) make_legible(instance.name);
  for (Room& room : scene.rooms) make_legible(room.name);
  for (Material& material : scene.materials) make_legible(material.name);
}

Scene load(const std::filesystem::path& file, std::vector<std::string>* warnings,
           const SceneFrame& frame) {
  if (file.native().starts_with(kGeneratedPrefix))
    return built(generate_scene(parse_generated(file.native())), file, frame);
  if (is_scannet_scene(file) || is_folder(file))
    return settled(turned(load_scannet(file, warnings), frame), frame, warnings);
  constexpr std::array<std::string_view, 6> kMeshes = {".dae", ".glb", ".gltf",
                                                       ".obj", ".ply", ".stl"};
  const std::string ending = lower_case(file.extension().string());
  if (std::ranges::find(kMeshes, ending) != kMeshes.end())
    return settled(load_turned_mesh(file, frame.up, warnings), frame, warnings);
  if (ending == ".yaml" || ending == ".yml") {
    if (!is_placed_scene(file)) return built(load_house(file), file, frame);
    SceneFrame reported = placed_frame(file);
    if (frame.up) reported.up = frame.up;
    if (frame.floor_z_m) reported.floor_z_m = frame.floor_z_m;
    return settled(load_placed_scene(file, warnings, reported.up), reported, warnings);
  }
  if (ending == ".sdf" || ending == ".world")
    return settled(turned(load_gazebo_world(file, warnings), frame), frame, warnings);
  throw InputError(
      fmt::format("{}: unknown kind of scene: the ending must be .yaml, .ply, .obj, .glb, .gltf, "
                  ".dae, .stl, .sdf or .world",
                  file.string()));
}

}  // namespace

Scene load_scene(const std::filesystem::path& file, std::vector<std::string>* warnings,
                 const SceneFrame& frame) {
  std::vector<std::string> unheard;  // so that the same files are read even without `warnings`
  if (warnings == nullptr) warnings = &unheard;
  try {
    Scene scene = load(file, warnings, frame);
    make_legible(scene);
    for (std::string& warning : *warnings) make_legible(warning);
    return scene;
  } catch (const InputError& error) {
    const std::string_view what = error.what();
    if (!what.starts_with("scene ")) throw;
    throw InputError(fmt::format("{}: {}", file.string(), what));  // a Scene has no file name
  }
}

}  // namespace mh
