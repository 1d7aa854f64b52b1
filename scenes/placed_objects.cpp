// SPDX-License-Identifier: Apache-2.0
#include "scenes/placed_objects.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "scenes/floor.hpp"
#include "scenes/guard.hpp"
#include "scenes/mesh_io/image_in.hpp"
#include "scenes/mesh_io/instances_in.hpp"
#include "scenes/mesh_io/mesh_io.hpp"
#include "scenes/mesh_io/node_name.hpp"
#include "scenes/placed_scene_file.hpp"
#include "scenes/scannet/files.hpp"
#include "scenes/scannet/scannet.hpp"
#include "scenes/thin_images.hpp"
#include "slam/io/error.hpp"
#include "slam/io/yaml.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kMostIds = std::numeric_limits<std::uint16_t>::max();

/// Appends a per-vertex array; if only one of the two scenes has it, the other's part is filled
/// with `neutral`.
template <class T>
void append_values(std::vector<T>& whole, std::size_t before, const std::vector<T>& part,
                   std::size_t count, const T& neutral) {
  if (whole.empty() && part.empty()) return;
  whole.resize(before, neutral);
  whole.insert(whole.end(), part.begin(), part.end());
  whole.resize(before + count, neutral);
}

void make_one_object(Scene& part, ClassId class_id) {
  part.instances = {{.id = 1, .class_id = class_id, .name = "object"}};
  std::ranges::fill(part.instance_of, InstanceId{1});
  std::ranges::fill(part.class_of, class_id);
}

/// Adds the objects of a part. @returns the new id for each of the part's ids
std::vector<InstanceId> enter_objects(Scene& scene, const Scene& part, const std::string& prefix) {
  const std::size_t first = scene.instances.empty() ? 1 : scene.instances.back().id + 1U;
  if (first + part.instances.size() > kMostIds + 1)
    throw InputError(fmt::format("scene {}: {}: more than 65535 objects", scene.name, prefix));
  std::vector<InstanceId> renamed(kMostIds + 1, 0);
  for (std::size_t i = 0; i < part.instances.size(); ++i) {
    Instance instance = part.instances[i];
    renamed[instance.id] = static_cast<InstanceId>(first + i);
    instance.id = static_cast<InstanceId>(first + i);
    instance.name = part.instances.size() == 1 ? prefix : prefix + "/" + instance.name;
    scene.instances.push_back(std::move(instance));
  }
  return renamed;
}

PlacedScene read(const fs::path& yaml) {
  return read_placed_scene(YamlReader::load(yaml), yaml.parent_path(), yaml.stem().string());
}

/// Loads a mesh, or a ScanNet scene with its labels. If a mesh has no labels, its class comes from
/// the object's name.
Scene load_object(const PlacedObject& object, const PlacedScene& placed, std::optional<UpAxis> up,
                  std::vector<std::string>* warnings, ImageStore* images) {
  if (is_scannet_scene(object.file)) {
    Scene scan = load_scannet(object.file, warnings);
    if ((object.up ? object.up : up) == UpAxis::kY) turn_y_up(scan);
    return scan;
  }
  Scene part = load_turned_mesh(object.file, object.up ? object.up : up, warnings, placed.rules,
                                {.images = images});
  const auto is_void = [](ClassId id) { return id == kVoid; };
  if (std::ranges::all_of(part.class_of, is_void)) {
    const ClassId named = placed.rules.find({object.name}).value_or(guess_class(object.name));
    std::ranges::fill(part.class_of, named);
    for (Instance& instance : part.instances) instance.class_id = named;
  }
  return part;
}

}  // namespace

void append_part(Scene& scene, Scene part, const Eigen::Affine3d& scene_from_part,
                 const std::string& prefix, std::optional<ClassId> class_id) {
  if (class_id) make_one_object(part, *class_id);
  const std::size_t before = scene.positions_m.size(), count = part.positions_m.size();
  const std::size_t first_material = scene.materials.size();
  if (first_material + part.materials.size() > kMostIds)
    throw InputError(fmt::format("scene {}: {}: more than 65535 materials", scene.name, prefix));
  const std::vector<InstanceId> renamed = enter_objects(scene, part, prefix);

  append_values(scene.uvs, before, part.uvs, count, Eigen::Vector2f::Zero().eval());
  append_values(scene.colors, before, part.colors, count, Rgb8{255, 255, 255});
  append_values(scene.light, before, part.light, count, Eigen::Vector3f::Ones().eval());
  for (const Eigen::Vector3f& p : part.positions_m)
    scene.positions_m.push_back((scene_from_part * p.cast<double>()).cast<float>());
  for (std::size_t face = 0; face < part.triangles.size(); ++face) {
    const auto& [a, b, c] = part.triangles[face];
    const auto moved = static_cast<std::uint32_t>(before);
    scene.triangles.push_back({a + moved, b + moved, c + moved});
    scene.material_of.push_back(
        static_cast<std::uint16_t>(part.material_of[face] + first_material));
    scene.class_of.push_back(part.class_of[face]);
    scene.instance_of.push_back(renamed[part.instance_of[face]]);
  }
  std::ranges::move(part.materials, std::back_inserter(scene.materials));
}

void finish_parts(Scene& scene) {
  if (scene.triangles.empty())
    throw InputError(fmt::format("scene {}: has nothing visible", scene.name));
  thin_images(scene);
  find_boxes(scene);
  rooms_from_floors(scene);
  validate(scene);
}

SceneFrame placed_frame(const fs::path& yaml) {
  return read(yaml).frame;
}

bool is_placed_scene(const fs::path& yaml) {
  return YamlReader::load(yaml).has("objects");
}

Scene load_placed_scene(const fs::path& yaml, std::vector<std::string>* warnings,
                        std::optional<UpAxis> up) {
  const PlacedScene placed = read(yaml);
  return load_guarded(yaml, warnings, [&](std::vector<std::string>* reported) {
    Scene scene;
    scene.name = placed.name;
    ImageStore images;
    for (const PlacedObject& object : placed.objects)
      append_part(scene, load_object(object, placed, up, reported, &images),
                  object.scene_from_object, object.name, object.class_id);
    finish_parts(scene);
    return scene;
  });
}

}  // namespace mh
