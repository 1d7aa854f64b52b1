// SPDX-License-Identifier: Apache-2.0
#include "scenes/placed_scene_file.hpp"

#include <numbers>
#include <set>

#include <fmt/format.h>

#include "slam/io/suggest.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

Eigen::Vector3d vector_of(const YamlReader& yaml) {
  const std::vector<double> n = yaml.as_numbers(3);
  return {n[0], n[1], n[2]};
}

PlacedObject read_object(YamlReader yaml, const fs::path& folder) {
  PlacedObject plan;
  plan.file = folder / yaml.string("file");
  plan.name = yaml.string("name", plan.file.stem().string());
  if (const auto class_name = yaml.find("class")) {
    plan.class_id = class_by_name(class_name->as_string());
    if (!plan.class_id)
      class_name->fail(
          fmt::format("'{}' is not a class{}", class_name->as_string(),
                      hint(class_name->as_string(), words_of(classes(), &ClassInfo::name),
                           "modelhouse reference classes lists all")));
  }
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero(), scale = Eigen::Vector3d::Ones();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  if (const auto node = yaml.find("position_m")) position_m = vector_of(*node);
  if (const auto node = yaml.find("rpy_deg"))
    rotation = rotation_of_rpy(vector_of(*node) * (std::numbers::pi / 180.0));
  if (const auto node = yaml.find("scale")) {
    scale = node->is_sequence() ? vector_of(*node) : Eigen::Vector3d::Constant(node->as_double());
    if ((scale.array() == 0.0).any()) node->fail("a scale must not be 0");
  }
  plan.scene_from_object.linear() = rotation * scale.asDiagonal();
  plan.scene_from_object.translation() = position_m;
  plan.up = read_scene_frame(yaml).up;
  yaml.finish();
  return plan;
}

}  // namespace

PlacedScene read_placed_scene(YamlReader yaml, const fs::path& folder, const std::string& name) {
  PlacedScene scene;
  scene.name = yaml.string("name", name);
  if (const auto labels = yaml.find("labels")) scene.rules = read_label_rules(*labels);
  scene.frame = read_scene_frame(yaml);
  std::set<std::string> names;
  for (const YamlReader& item : yaml.at("objects").items()) {
    scene.objects.push_back(read_object(item, folder));
    if (!names.insert(scene.objects.back().name).second)
      item.fail(fmt::format("name '{}' is taken by an object above", scene.objects.back().name));
  }
  yaml.finish();
  return scene;
}

Eigen::Matrix3d rotation_of_rpy(const Eigen::Vector3d& rpy_rad) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(rpy_rad.z(), Vector3d::UnitZ()) * AngleAxisd(rpy_rad.y(), Vector3d::UnitY()) *
          AngleAxisd(rpy_rad.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace mh
