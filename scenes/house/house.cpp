// SPDX-License-Identifier: Apache-2.0
#include "scenes/house/house.hpp"

#include <cassert>
#include <vector>

#include "scenes/house/plan_file.hpp"
#include "scenes/house/shell.hpp"
#include "scenes/name_key.hpp"
#include "slam/io/yaml.hpp"

namespace mh {
namespace {

void add_lamp_light(const ItemPlan& item, Scene& scene) {
  if (!item.kind->bulb || !item.glow) return;
  Light light{.kind = Light::Kind::kSphere, .color = *item.glow};
  light.position_m = item.position_m.cast<float>();
  light.position_m.z() += *item.kind->bulb * static_cast<float>(item.size_m.z());
  light.radius_m = item.kind->mount == Mount::kCeiling ? 0.06F : 0.03F;
  scene.lights.push_back(light);
}

void build_item(const ItemPlan& item, MeshBuilder& mesh) {
  const auto class_id = class_by_name(item.kind->class_name);
  assert(class_id);
  mesh.begin_instance(item.name, *class_id);
  Eigen::Isometry3f world_from_piece = Eigen::Isometry3f::Identity();
  world_from_piece.translation() = item.position_m.cast<float>();
  mesh.push(world_from_piece * turn_z(static_cast<float>(item.turn_rad)));
  Piece piece(mesh, item.name, item.size_m.cast<float>(), item.materials,
              RandomStream(name_key(item.name)));
  item.kind->build(piece);
  mesh.pop();
}

Scene build(const HousePlan& house, bool painted = true) {
  MeshBuilder mesh;
  mesh.painted = painted;
  mesh.scene().name = house.name;
  mesh.detail = static_cast<float>(house.detail);
  build_shell(house, mesh);
  for (const ItemPlan& item : house.items) build_item(item, mesh);
  Scene scene = mesh.finish();
  if (house.sun) scene.lights.push_back(*house.sun);
  if (house.sky) scene.lights.push_back(*house.sky);
  for (const ItemPlan& item : house.items) add_lamp_light(item, scene);
  for (const RoomPlan& room : house.rooms) {
    scene.rooms.push_back({room.name, room.outline_m()});
  }
  validate(scene);
  return scene;
}

}  // namespace

Scene load_house(const std::filesystem::path& yaml) {
  return build(read_house_plan(YamlReader::load(yaml)));
}

Scene build_house(const std::string& yaml_text, const std::string& name) {
  return build(read_house_plan(YamlReader::parse(yaml_text, name)));
}

std::size_t count_triangles(const std::string& yaml_text, const std::string& name) {
  return build(read_house_plan(YamlReader::parse(yaml_text, name)), false).triangles.size();
}

}  // namespace mh
