// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/instances_in.hpp"

#include <limits>
#include <optional>

namespace mh {

void find_boxes(Scene& scene) {
  std::vector<Instance*> by_id(65536, nullptr);
  for (Instance& instance : scene.instances) {
    instance.min_m.setConstant(std::numeric_limits<float>::infinity());
    instance.max_m = -instance.min_m;
    by_id[instance.id] = &instance;
  }
  for (std::size_t face = 0; face < scene.triangles.size(); ++face)
    if (Instance* instance = by_id[scene.instance_of[face]])
      for (const std::uint32_t vertex : scene.triangles[face]) {
        instance->min_m = instance->min_m.cwiseMin(scene.positions_m[vertex]);
        instance->max_m = instance->max_m.cwiseMax(scene.positions_m[vertex]);
      }
  for (Instance& instance : scene.instances)  // instances without faces
    if (!instance.min_m.allFinite()) instance.min_m = instance.max_m = Eigen::Vector3f::Zero();
}

void rooms_from_floors(Scene& scene) {
  constexpr float kLeastRoom_m2 = 1.0F;
  const std::optional<ClassId> floor = class_by_name("floor");
  for (const Instance& instance : scene.instances) {
    const Eigen::Vector3f size = instance.max_m - instance.min_m;
    if (instance.class_id != floor || size.x() * size.y() < kLeastRoom_m2) continue;
    const Eigen::Vector3d low = instance.min_m.cast<double>(), high = instance.max_m.cast<double>();
    scene.rooms.push_back({.name = instance.name.substr(0, instance.name.find('/')),
                           .polygon_m = {{low.x(), low.y()},
                                         {high.x(), low.y()},
                                         {high.x(), high.y()},
                                         {low.x(), high.y()}},
                           .is_box = true});
  }
}

}  // namespace mh
