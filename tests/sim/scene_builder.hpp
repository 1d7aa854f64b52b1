// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "scenes/scene.hpp"

namespace mh::test {

/// Adds a parallelogram origin, origin + a, origin + a + b, origin + b, cut into n x n cells of two
/// triangles. Its front is the side of a x b; u runs from 0 to 1 along a, v along b.
inline void add_quad(Scene& scene, const Eigen::Vector3f& origin, const Eigen::Vector3f& a,
                     const Eigen::Vector3f& b, ClassId class_id, InstanceId instance,
                     std::uint16_t material = 0, std::uint32_t n = 1) {
  const auto first = static_cast<std::uint32_t>(scene.positions_m.size());
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) {
      const float s = static_cast<float>(i) / static_cast<float>(n);
      const float t = static_cast<float>(j) / static_cast<float>(n);
      scene.positions_m.push_back(origin + s * a + t * b);
      scene.uvs.emplace_back(s, t);
    }
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t p = first + j * (n + 1) + i, q = p + n + 1;
      scene.triangles.push_back({p, p + 1, q + 1});
      scene.triangles.push_back({p, q + 1, q});
      for (int k = 0; k < 2; ++k) {
        scene.class_of.push_back(class_id);
        scene.instance_of.push_back(instance);
        scene.material_of.push_back(material);
      }
    }
  while (scene.instances.size() < instance) {
    Instance added;
    added.id = static_cast<InstanceId>(scene.instances.size() + 1);
    added.class_id = class_id;
    added.name = "object_" + std::to_string(added.id);
    scene.instances.push_back(added);
  }
}

/// A scene with one plain material of this sRGB color.
inline Scene plain_scene(Rgb8 color = {255, 255, 255}) {
  Scene scene;
  scene.name = "test";
  Material material;
  material.name = "plain";
  material.base_color = color;
  scene.materials.push_back(material);
  return scene;
}

/// Adds an axis-aligned box; its faces look outward, or inward for a room.
inline void add_box(Scene& scene, const Eigen::Vector3f& low, const Eigen::Vector3f& high,
                    bool inwards, ClassId class_id, InstanceId instance, std::uint16_t material = 0,
                    std::uint32_t n = 1) {
  const Eigen::Vector3f x(high.x() - low.x(), 0, 0), y(0, high.y() - low.y(), 0),
      z(0, 0, high.z() - low.z());
  const auto side = [&](const Eigen::Vector3f& o, const Eigen::Vector3f& a,
                        const Eigen::Vector3f& b) {
    add_quad(scene, o, inwards ? b : a, inwards ? a : b, class_id, instance, material, n);
  };
  side(low, y, x), side(low, x, z), side(low, z, y);
  side(low + z, x, y), side(low + y, z, x), side(low + x, y, z);
}

}  // namespace mh::test
