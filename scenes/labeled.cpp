// SPDX-License-Identifier: Apache-2.0
#include "scenes/labeled.hpp"

#include <algorithm>
#include <functional>
#include <map>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <nlohmann/json.hpp>

namespace mh {
namespace {

/// The pattern for an object's name: "kitchen/Handle_01" becomes "Handle*".
std::string pattern_of(const std::string& name) {
  std::string_view last = std::string_view(name).substr(name.rfind('/') + 1);
  const std::size_t end = last.find_last_not_of("0123456789_.- ");
  if (end != last.npos) last = last.substr(0, end + 1);
  std::string pattern;
  for (const char c : last) {
    if (std::string_view("*?[]\\").find(c) != std::string_view::npos) pattern += '\\';
    pattern += c;
  }
  return pattern + "*";
}

}  // namespace

LabeledSurface survey_labels(const Scene& scene) {
  std::vector<const std::string*> name_of(65536, nullptr);
  for (const Instance& instance : scene.instances) name_of[instance.id] = &instance.name;
  LabeledSurface surface;
  std::map<std::string, double> area_of;
  std::map<const std::string*, std::string> patterns;  // looked up, never iterated over
  for (std::size_t face = 0; face < scene.triangles.size(); ++face) {
    const auto& [a, b, c] = scene.triangles[face];
    const Eigen::Vector3d p = scene.positions_m[a].cast<double>();
    const double area_m2 = 0.5 * (scene.positions_m[b].cast<double>() - p)
                                     .cross(scene.positions_m[c].cast<double>() - p)
                                     .norm();
    surface.area_m2 += area_m2;
    if (scene.class_of[face] != kVoid) {
      surface.labeled_m2 += area_m2;
      continue;
    }
    const std::string* name = name_of[scene.instance_of[face]];
    if (name == nullptr) name = &scene.materials[scene.material_of[face]].name;
    const auto [pattern, is_new] = patterns.try_emplace(name);
    if (is_new) pattern->second = pattern_of(*name);
    area_of[pattern->second] += area_m2;
  }
  for (const auto& [pattern, area_m2] : area_of) surface.unlabeled.push_back({pattern, area_m2});
  std::ranges::stable_sort(surface.unlabeled, std::greater<>(),
                           &LabeledSurface::Unlabeled::area_m2);
  return surface;
}

std::string suggested_labels(const LabeledSurface& surface) {
  std::string text = fmt::format(
      "# What has no class, the largest first ({:.0f} % of {:.1f} m2 have one). Put a class in the "
      "place of void\n# and save it as labels.yaml beside the mesh.\n",
      100 * surface.share(), surface.area_m2);
  if (surface.unlabeled.empty()) return text + "{}\n";
  for (const auto& [pattern, area_m2] : surface.unlabeled)
    text += fmt::format(
        "{}: void  # {:.2f} m2\n",
        nlohmann::json(pattern).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
        area_m2);
  return text;
}

}  // namespace mh
