// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_builder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>

namespace mh {

using Eigen::Vector2f;
using Eigen::Vector3f;

std::vector<float> breaks(float a, float b, float step, std::vector<float> stops) {
  std::erase_if(stops, [&](float s) { return s <= a + 1e-5F || s >= b - 1e-5F; });
  stops.push_back(a);
  stops.push_back(b);
  std::sort(stops.begin(), stops.end());
  stops.erase(std::unique(stops.begin(), stops.end(),
                          [](float x, float y) { return std::abs(x - y) < 1e-5F; }),
              stops.end());
  std::vector<float> result{stops.front()};
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const float from = stops[i - 1], to = stops[i];
    const int n = std::max(1, static_cast<int>(std::ceil((to - from) / step - 1e-4F)));
    for (int k = 1; k < n; ++k)
      result.push_back(from + (to - from) * static_cast<float>(k) / static_cast<float>(n));
    result.push_back(to);
  }
  return result;
}

Eigen::Isometry3f translation(float x, float y, float z) {
  return Eigen::Isometry3f(Eigen::Translation3f(x, y, z));
}

Eigen::Isometry3f turn(const Vector3f& axis, float angle_rad) {
  return Eigen::Isometry3f(Eigen::AngleAxisf(angle_rad, axis));
}

Eigen::Isometry3f turn_z(float angle_rad) {
  return turn(Vector3f::UnitZ(), angle_rad);
}

MaterialId MeshBuilder::material(const MaterialSpec& spec, const Vector3f& emission) {
  const std::string key =
      fmt::format("{}|{}|{},{},{}|{}|{}|{},{}|{},{},{}", spec.name, spec.kind, spec.tone.r,
                  spec.tone.g, spec.tone.b, spec.variation, spec.seed, spec.size_m.x(),
                  spec.size_m.y(), emission.x(), emission.y(), emission.z());
  const auto [found, is_new] =
      materials_.try_emplace(key, static_cast<MaterialId>(scene_.materials.size()));
  if (is_new) {
    validate(spec);
    scene_.materials.push_back(painted ? make_material(spec) : Material{});
    scene_.materials.back().emission = emission;
  }
  return found->second;
}

InstanceId MeshBuilder::begin_instance(const std::string& name, ClassId class_id) {
  const auto id = static_cast<InstanceId>(scene_.instances.size() + 1);
  Instance instance;
  instance.id = id;
  instance.class_id = class_id;
  instance.name = name;
  scene_.instances.push_back(instance);
  resume_instance(id);
  return id;
}

void MeshBuilder::resume_instance(InstanceId id) {
  assert(id <= scene_.instances.size());
  instance_ = id;
  class_ = id == 0 ? kVoid : scene_.instances[id - 1].class_id;
}

void MeshBuilder::push(const Eigen::Isometry3f& outer_from_inner) {
  frames_.push_back(frames_.back() * outer_from_inner);
}

void MeshBuilder::pop() {
  assert(frames_.size() > 1);
  frames_.pop_back();
}

std::uint32_t MeshBuilder::vertex(MaterialId material, const Vector3f& local, const Vector2f& uv) {
  scene_.positions_m.emplace_back(frames_.back() * local);
  scene_.uvs.push_back(uv);
  material_of_vertex_.push_back(material);
  return static_cast<std::uint32_t>(scene_.positions_m.size() - 1);
}

void MeshBuilder::triangle(MaterialId material, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const Vector3f &pa = scene_.positions_m[a], &pb = scene_.positions_m[b],
                 &pc = scene_.positions_m[c];
  // At the poles of round shapes two corners coincide; omitting such a face leaves no gap.
  if ((pb - pa).cross(pc - pa).norm() < 1e-9F) return;
  scene_.triangles.push_back({a, b, c});
  scene_.material_of.push_back(material);
  scene_.class_of.push_back(class_);
  scene_.instance_of.push_back(instance_);
}

void MeshBuilder::grid_faces(MaterialId material, const Grid& grid, int nu, int nv, bool flip) {
  const auto at = [&](int i, int j) { return grid[static_cast<std::size_t>(j * (nu + 1) + i)]; };
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      const std::uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      if (flip) {
        triangle(material, a, c, b);
        triangle(material, a, d, c);
      } else {
        triangle(material, a, b, c);
        triangle(material, a, c, d);
      }
    }
}

int MeshBuilder::cells(float length_m) const {
  return std::max(1, static_cast<int>(std::ceil(length_m * detail / max_edge_m - 1e-4F)));
}

Scene MeshBuilder::finish() {
  for (std::size_t i = 0; i < scene_.uvs.size(); ++i)
    scene_.uvs[i] = scene_.uvs[i].cwiseQuotient(scene_.materials[material_of_vertex_[i]].tile_m);
  std::vector<char> seen(scene_.instances.size() + 1, 0);
  for (std::size_t f = 0; f < scene_.triangles.size(); ++f) {
    const InstanceId id = scene_.instance_of[f];
    if (id == 0) continue;
    Instance& instance = scene_.instances[id - 1];
    for (const std::uint32_t v : scene_.triangles[f]) {
      const Vector3f& p = scene_.positions_m[v];
      if (!seen[id]) instance.min_m = instance.max_m = p;
      seen[id] = 1;
      instance.min_m = instance.min_m.cwiseMin(p);
      instance.max_m = instance.max_m.cwiseMax(p);
    }
  }
  return std::move(scene_);
}

}  // namespace mh
