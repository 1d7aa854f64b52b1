// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "scenes/scene.hpp"
#include "slam/core/random.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// A room with 225 boxes in it, all cut into even triangles, with textures of block noise at 2 mm
/// per texel (near the worst case for a texture cache) and spatially varying light.
class BenchmarkRoom {
 public:
  /// @param wall_cells, box_cells  per side of each wall and of each box
  static Scene make(std::uint32_t wall_cells, std::uint32_t box_cells) {
    BenchmarkRoom room;
    room.box({0, 0, 0}, {8, 7.5F, 2.6F}, wall_cells);
    const RandomStream stream(2);
    for (std::uint64_t i = 0; i < 225; ++i) {
      const auto u = [&](std::uint64_t k, double low, double high) {
        return static_cast<float>(stream.uniform(8 * i + k, low, high));
      };
      room.box({u(0, 0.1, 7.5), u(1, 0.1, 7.0), u(2, 0.0, 1.2)},
               {u(3, 0.1, 0.6), u(4, 0.1, 0.6), u(5, 0.1, 0.8)}, box_cells);
    }
    return std::move(room.scene_);
  }

  static Scene usual() { return make(115, 8); }     ///< 331,500 triangles
  static Scene tenfold() { return make(352, 26); }  ///< 3,312,048 triangles

 private:
  using Vector3f = Eigen::Vector3f;

  BenchmarkRoom() {
    const RandomStream stream(1);
    for (std::uint64_t m = 0; m < 4; ++m) {
      Material material;
      material.name = "noise_" + std::to_string(m);
      Grid2d<Rgb8> texture(1024, 1024);
      for (int y = 0; y < 1024; ++y)
        for (int x = 0; x < 1024; ++x) {
          const std::uint64_t block = static_cast<std::uint64_t>(y / 2 * 512 + x / 2);
          const auto gray = static_cast<std::uint8_t>(stream.fork(m).below(block, 256));
          texture(x, y) = {gray, static_cast<std::uint8_t>(255 - gray), 128};
        }
      material.texture = std::move(texture);
      scene_.materials.push_back(material);
    }
    scene_.name = "benchmark";
  }

  void quad(const Vector3f& o, const Vector3f& a, const Vector3f& b, std::uint32_t n) {
    const auto first = static_cast<std::uint32_t>(scene_.positions_m.size());
    for (std::uint32_t j = 0; j <= n; ++j)
      for (std::uint32_t i = 0; i <= n; ++i) {
        const float s = static_cast<float>(i) / static_cast<float>(n);
        const float t = static_cast<float>(j) / static_cast<float>(n);
        scene_.positions_m.push_back(o + s * a + t * b);
        scene_.uvs.emplace_back(s * a.norm() / 2.0F, t * b.norm() / 2.0F);
        scene_.light.push_back(Vector3f::Constant(0.3F + 0.5F * s * t));
      }
    const auto object = static_cast<InstanceId>(scene_.instances.size());
    for (std::uint32_t j = 0; j < n; ++j)
      for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t p = first + j * (n + 1) + i, q = p + n + 1;
        scene_.triangles.push_back({p, p + 1, q + 1});
        scene_.triangles.push_back({p, q + 1, q});
        for (int k = 0; k < 2; ++k) {
          scene_.class_of.push_back(scene_.instances.back().class_id);
          scene_.instance_of.push_back(object);
          scene_.material_of.push_back(object % 4);
        }
      }
  }

  void box(const Vector3f& low, const Vector3f& size, std::uint32_t n) {
    Instance added;
    added.id = static_cast<InstanceId>(scene_.instances.size() + 1);
    added.class_id = static_cast<ClassId>(1 + added.id % 40);
    added.name = "box_" + std::to_string(added.id);
    scene_.instances.push_back(added);
    const Vector3f x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
    quad(low, y, x, n), quad(low, x, z, n), quad(low, z, y, n);
    quad(low + z, x, y, n), quad(low + y, z, x, n), quad(low + x, y, z, n);
  }

  Scene scene_;
};

/// View i of twelve around the middle of that room.
inline SE3 benchmark_view(int i) {
  const double heading = i * std::numbers::pi / 6.0, c = std::cos(heading), s = std::sin(heading);
  Eigen::Matrix3d rotation;
  rotation << s, 0, c, -c, 0, s, 0, -1, 0;
  return {rotation, {4.0 + 2.0 * s, 3.7 - 2.0 * c, 1.1}};
}

}  // namespace mh
