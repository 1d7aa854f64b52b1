// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>

#include "scenes/mesh_io/instances_in.hpp"
#include "scenes/scene.hpp"
#include "slam/core/random.hpp"

namespace mh::test {

/// A room of 6 x 5 m around the origin as a scanner records it: faces of about 5 cm, a bumpy floor.
struct ScannedRoom {
  double floor_z_m = 0.055, noise_m = 0.01;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  bool labeled = true;
  /// Whether the scan has floor at a place.
  std::function<bool(double x, double y)> has_floor = [](double, double) { return true; };

  Scene build() const {
    Scene scene;
    scene.name = "scanned room";
    scene.materials.push_back({.name = "scan", .texture = {}});
    scene.instances.push_back(
        {.id = 1, .class_id = labeled ? class_of("floor") : kVoid, .name = "floor"});
    scene.instances.push_back(
        {.id = 2, .class_id = labeled ? class_of("wall") : kVoid, .name = "wall"});
    add_floor(scene);
    const Eigen::Vector3f up(0, 0, 2.5F);
    for (const float side : {-1.0F, 1.0F}) {
      add_sheet(scene, {-3, 2.5F * side, height(-3, 2.5 * side)}, {6, 0, 0}, up, 2);
      add_sheet(scene, {3 * side, -2.5F, height(3 * side, -2.5)}, {0, 5, 0}, up, 2);
    }
    find_boxes(scene);
    return scene;
  }
  float height(double x, double y) const {
    return static_cast<float>(floor_z_m + slope.dot(Eigen::Vector2d(x, y)));
  }
  static ClassId class_of(const char* name) { return *class_by_name(name); }

  /// Adds a parallelogram of two faces.
  static void add_sheet(Scene& scene, const Eigen::Vector3f& at, const Eigen::Vector3f& a,
                        const Eigen::Vector3f& b, InstanceId instance) {
    const auto first = static_cast<std::uint32_t>(scene.positions_m.size());
    for (const Eigen::Vector3f& p :
         {at, Eigen::Vector3f(at + a), Eigen::Vector3f(at + a + b), Eigen::Vector3f(at + b)})
      scene.positions_m.push_back(p);
    add_face(scene, {first, first + 1, first + 2}, instance);
    add_face(scene, {first, first + 2, first + 3}, instance);
  }
  static void add_face(Scene& scene, const std::array<std::uint32_t, 3>& corners,
                       InstanceId instance) {
    scene.triangles.push_back(corners);
    scene.material_of.push_back(0);
    scene.instance_of.push_back(instance);
    scene.class_of.push_back(scene.instances[instance - 1U].class_id);
  }
  /// Adds a table without a class, of this size, whose top is 0.75 m above the center of the floor.
  void add_table(Scene& scene, double width_m, double depth_m) const {
    scene.instances.push_back({.id = 3, .name = "table"});
    const float w = static_cast<float>(width_m), d = static_cast<float>(depth_m);
    const float top = static_cast<float>(floor_z_m + 0.75);
    add_sheet(scene, {-w / 2, -d / 2, top}, {w, 0, 0}, {0, d, 0}, 3);
    for (const float x : {-w / 2, w / 2})
      for (const float y : {-d / 2, d / 2})
        add_sheet(scene, {x, y, static_cast<float>(floor_z_m)}, {0.05F, 0, 0}, {0, 0, 0.75F}, 3);
    find_boxes(scene);
  }

 private:
  void add_floor(Scene& scene) const {
    constexpr int kWide = 120, kDeep = 100;
    const RandomStream noise(7);
    for (int j = 0; j <= kDeep; ++j)
      for (int i = 0; i <= kWide; ++i) {
        const double x = -3 + 6.0 * i / kWide, y = -2.5 + 5.0 * j / kDeep;
        const double bump = noise_m * noise.normal(static_cast<std::uint64_t>(j * 1000 + i));
        scene.positions_m.emplace_back(static_cast<float>(x), static_cast<float>(y),
                                       height(x, y) + static_cast<float>(bump));
      }
    for (int j = 0; j < kDeep; ++j)
      for (int i = 0; i < kWide; ++i) {
        if (!has_floor(-3 + 6.0 * (i + 0.5) / kWide, -2.5 + 5.0 * (j + 0.5) / kDeep)) continue;
        const auto p = static_cast<std::uint32_t>(j * (kWide + 1) + i), q = p + kWide + 1;
        add_face(scene, {p, p + 1, q + 1}, 1);
        add_face(scene, {p, q + 1, q}, 1);
      }
  }
};

}  // namespace mh::test
