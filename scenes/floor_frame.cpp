// SPDX-License-Identifier: Apache-2.0
// What depends on a detected floor: its frame, and the clipping of rooms.
#include <algorithm>

#include <Eigen/Dense>

#include "scenes/floor.hpp"
#include "scenes/mesh_io/instances_in.hpp"

namespace mh {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

void end_rooms_near_things(std::vector<Room>& rooms, const Eigen::AlignedBox2d& things_m) {
  constexpr double kMargin_m = 2.0;
  if (things_m.isEmpty()) return;
  const Vector2d low = things_m.min().array() - kMargin_m,
                 high = things_m.max().array() + kMargin_m;
  for (Room& room : rooms)
    if (room.is_box)
      for (Vector2d& corner : room.polygon_m) corner = corner.cwiseMax(low).cwiseMin(high);
  const auto is_away = [](const Room& room) {  // the room was entirely outside
    return room.is_box && room.polygon_m.size() == 4 &&
           ((room.polygon_m[2] - room.polygon_m[0]).array() <= 0).any();
  };
  if (!std::ranges::all_of(rooms, is_away)) std::erase_if(rooms, is_away);
}

void turn_y_up(Scene& scene, bool back) {
  const auto turn = [back](Vector3f& p) {
    p = back ? Vector3f(p.x(), p.z(), -p.y()) : Vector3f(p.x(), -p.z(), p.y());
  };
  std::ranges::for_each(scene.positions_m, turn);
  for (Light& light : scene.lights) turn(light.position_m), turn(light.direction);
  find_boxes(scene);
  scene.rooms.clear();
  rooms_from_floors(scene);
}

SE3 world_from_floor(const Floor& floor) {
  const Eigen::Matrix3d rotation =
      Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), floor.up).toRotationMatrix();
  const Vector3d flat(floor.middle_m.x(), floor.middle_m.y(), 0.0);
  if (floor.up == Vector3d::UnitZ())
    return {Eigen::Matrix3d::Identity(), {0.0, 0.0, floor.middle_m.z()}};
  return {rotation, floor.middle_m - rotation * flat};
}

LevelScene::LevelScene(const Scene& scene) : scene_(scene) {
  if (scene.floor.is_level_zero()) return;
  world_from_level_ = world_from_floor(scene.floor);
  const SE3 level_from_world = world_from_level_.inverse();
  copy_.emplace();
  copy_->name = scene.name;
  copy_->triangles = scene.triangles;
  copy_->class_of = scene.class_of;
  copy_->instance_of = scene.instance_of;
  copy_->instances = scene.instances;
  copy_->rooms = scene.rooms;
  copy_->floor.rough_m = scene.floor.rough_m;
  copy_->floor.area_m2 = scene.floor.area_m2;
  copy_->positions_m.reserve(scene.positions_m.size());
  for (const Vector3f& p : scene.positions_m)
    copy_->positions_m.push_back((level_from_world * p.cast<double>().eval()).cast<float>());
  find_boxes(*copy_);
}

}  // namespace mh
