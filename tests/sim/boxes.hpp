// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "robots/model/robot.hpp"
#include "scenes/scene.hpp"
#include "source_dir.hpp"

namespace mh::test {

/// Adds an upright box as one instance.
inline void add_box(Scene& scene, const std::string& name, const Eigen::Vector3f& min,
                    const Eigen::Vector3f& max) {
  const auto base = static_cast<std::uint32_t>(scene.positions_m.size());
  for (int corner = 0; corner < 8; ++corner)
    scene.positions_m.emplace_back((corner & 1) != 0 ? max.x() : min.x(),
                                   (corner & 2) != 0 ? max.y() : min.y(),
                                   (corner & 4) != 0 ? max.z() : min.z());
  const auto id = static_cast<InstanceId>(scene.instances.size() + 1);
  constexpr std::uint32_t kQuads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : kQuads)
    for (const auto& t : {std::array{q[0], q[1], q[2]}, std::array{q[0], q[2], q[3]}}) {
      scene.triangles.push_back({base + t[0], base + t[1], base + t[2]});
      scene.material_of.push_back(0);
      scene.class_of.push_back(1);
      scene.instance_of.push_back(id);
    }
  scene.instances.push_back({.id = id, .class_id = 1, .name = name, .min_m = min, .max_m = max});
}

/// A floor and four walls, 10 x 10 m, inside [0, 10]^2.
inline Scene empty_room() {
  Scene scene;
  scene.name = "empty room";
  scene.materials.emplace_back();
  add_box(scene, "floor", {0, 0, -0.1F}, {10, 10, 0});
  add_box(scene, "south wall", {-0.1F, -0.1F, 0}, {10.1F, 0, 2.5F});
  add_box(scene, "north wall", {-0.1F, 10, 0}, {10.1F, 10.1F, 2.5F});
  add_box(scene, "west wall", {-0.1F, 0, 0}, {0, 10, 2.5F});
  add_box(scene, "east wall", {10, 0, 0}, {10.1F, 10, 2.5F});
  scene.rooms.push_back({"room", {{0, 0}, {10, 0}, {10, 10}, {0, 10}}});
  return scene;
}

inline Robot pepper() {
  return load_robot(MH_SOURCE_DIR "/robots/pepper/pepper.yaml");
}

/// A robot with a differential drive.
inline Robot turtlebot() {
  return load_robot(MH_SOURCE_DIR "/robots/turtlebot3/turtlebot3.yaml");
}

}  // namespace mh::test
