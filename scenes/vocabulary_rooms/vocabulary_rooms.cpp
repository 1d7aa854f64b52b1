// SPDX-License-Identifier: Apache-2.0
#include "scenes/vocabulary_rooms/vocabulary_rooms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scenes/dice.hpp"
#include "scenes/vocabulary_rooms/patterns.hpp"
#include "slam/core/random.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kMaxEdge = 0.15F;  // m; baked light is stored at the vertices
/// Assembles a training room from flat and round faces.
class RoomMaker {
 public:
  explicit RoomMaker(std::uint64_t seed) : dice_(RandomStream(seed).fork(0x7261)) {
    scene_.name = fmt::format("training_room_{}", seed);
  }

  Scene make() {
    width_ = dice_.uniform(3.2, 6.0);
    depth_ = dice_.uniform(3.0, 5.0);
    height_ = dice_.uniform(2.4, 3.0);
    choose_materials();
    shell();
    for (int i = 0, count = dice_.whole(3, 7); i < count; ++i) panel(i);
    for (int i = 0, count = dice_.whole(1, 2); i < count; ++i) rack(i);
    for (int i = 0, count = dice_.whole(3, 6); i < count; ++i) crate(i);
    for (int i = 0, count = dice_.whole(2, 4); i < count; ++i) drum(i);
    for (int i = 0, count = dice_.whole(1, 3); i < count; ++i) slab(i);
    lamps();
    scene_.rooms = {
        {.name = "hall", .polygon_m = {{0, 0}, {width_, 0}, {width_, depth_}, {0, depth_}}}};
    measure();
    validate(scene_);
    return std::move(scene_);
  }

 private:
  void choose_materials() {
    const auto families = training_patterns();
    for (int i = 0; i < 11; ++i) {
      const auto family =
          families[static_cast<std::size_t>(dice_.whole(0, static_cast<int>(families.size()) - 1))];
      Material material = make_training_pattern(family, dice_.bits());
      // The same sheet at a different scale is a different pattern.
      material.tile_m *= dice_.uniform(0.7, 1.6);
      material.name += fmt::format("_{}", i);
      scene_.materials.push_back(std::move(material));
    }
  }

  std::uint16_t any_material() {
    return static_cast<std::uint16_t>(
        dice_.whole(0, static_cast<int>(scene_.materials.size()) - 1));
  }

  void begin(const std::string& name, std::string_view class_name) {
    const auto id = static_cast<InstanceId>(scene_.instances.size() + 1);
    scene_.instances.push_back(
        {.id = id, .class_id = class_by_name(class_name).value(), .name = name});
  }

  std::uint32_t vertex(const Vector3f& position, const Vector2f& uv) {
    scene_.positions_m.push_back(position);
    scene_.uvs.push_back(uv);
    return static_cast<std::uint32_t>(scene_.positions_m.size() - 1);
  }

  void face(std::uint16_t material, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    scene_.triangles.push_back({a, b, c});
    scene_.material_of.push_back(material);
    scene_.class_of.push_back(scene_.instances.back().class_id);
    scene_.instance_of.push_back(scene_.instances.back().id);
  }

  /// A surface point(s, t) over the unit square whose sides measure about size_m.
  template <class Point>
  void sheet(std::uint16_t material, const Vector2f& size_m, const Point& point,
             int min_cells = 1) {
    const Vector2f tile = scene_.materials[material].tile_m;
    const Vector2f start{dice_.uniform(0, 1), dice_.uniform(0, 1)};
    const int nu = std::max(min_cells, static_cast<int>(std::ceil(size_m.x() / kMaxEdge)));
    const int nv = std::max(1, static_cast<int>(std::ceil(size_m.y() / kMaxEdge)));
    const auto first = static_cast<std::uint32_t>(scene_.positions_m.size());
    for (int j = 0; j <= nv; ++j)
      for (int i = 0; i <= nu; ++i) {
        const float s = static_cast<float>(i) / static_cast<float>(nu);
        const float t = static_cast<float>(j) / static_cast<float>(nv);
        vertex(point(s, t), start + Vector2f(s * size_m.x() / tile.x(), t * size_m.y() / tile.y()));
      }
    for (int j = 0; j < nv; ++j)
      for (int i = 0; i < nu; ++i) {
        const auto corner = first + static_cast<std::uint32_t>(j * (nu + 1) + i);
        const auto below = corner + static_cast<std::uint32_t>(nu + 1);
        face(material, corner, below, corner + 1);
        face(material, corner + 1, below, below + 1);
      }
  }

  void quad(std::uint16_t material, const Vector3f& corner, const Vector3f& right,
            const Vector3f& down) {
    sheet(material, {right.norm(), down.norm()},
          [&](float s, float t) -> Vector3f { return corner + s * right + t * down; });
  }

  /// A box around a center; its axes are the columns of `axes`.
  void box(std::uint16_t material, const Vector3f& center, const Vector3f& size,
           const Eigen::Matrix3f& axes) {
    for (int axis = 0; axis < 3; ++axis)
      for (const float side : {-1.0F, 1.0F}) {
        const int a = axis == 2 ? 0 : (axis + 1) % 2, b = axis == 2 ? 1 : 2;
        const Vector3f right = axes.col(a) * size[a] * side, down = -axes.col(b) * size[b];
        const Vector3f middle = center + axes.col(axis) * (0.5F * side * size[axis]);
        quad(material, middle - 0.5F * right - 0.5F * down, right, down);
      }
  }

  static Eigen::Matrix3f turned(float yaw_rad) {
    return Eigen::AngleAxisf(yaw_rad, Vector3f::UnitZ()).toRotationMatrix();
  }

  void shell() {
    const float w = width_, d = depth_, h = height_;
    begin("floor", "floor");
    quad(0, {0, d, 0}, {w, 0, 0}, {0, -d, 0});
    begin("ceiling", "ceiling");
    quad(1, {0, 0, h}, {w, 0, 0}, {0, d, 0});
    begin("wall_south", "wall");
    quad(2, {w, 0, h}, {-w, 0, 0}, {0, 0, -h});
    begin("wall_north", "wall");
    quad(3, {0, d, h}, {w, 0, 0}, {0, 0, -h});
    begin("wall_west", "wall");
    quad(4, {0, 0, h}, {0, d, 0}, {0, 0, -h});
    begin("wall_east", "wall");
    quad(5, {w, d, h}, {0, -d, 0}, {0, 0, -h});
  }

  /// A thin plate on a wall.
  void panel(int index) {
    begin(fmt::format("panel_{}", index), "picture");
    const bool long_wall = dice_.whole(0, 1) == 1, far_side = dice_.whole(0, 1) == 1;
    const float length = long_wall ? width_ : depth_;
    const Vector3f size{dice_.uniform(0.4, 1.3), 0.02F, dice_.uniform(0.3, 1.1)};
    const float along = dice_.uniform(0.7, length - 0.7), z = dice_.uniform(1.0, height_ - 0.6);
    const float across = far_side ? (long_wall ? depth_ : width_) - 0.011F : 0.011F;
    const Vector3f center = long_wall ? Vector3f(along, across, z) : Vector3f(across, along, z);
    box(any_material(), center, size, turned(long_wall ? 0.0F : std::numbers::pi_v<float> / 2));
  }

  /// A place near the walls for something of this radius, leaving the center free.
  Vector2f place(float radius) {
    const float margin = radius + 0.05F;
    const float along_x = dice_.uniform(margin, width_ - margin);
    const float along_y = dice_.uniform(margin, depth_ - margin);
    const float near = margin + dice_.uniform(0.0, 0.3);
    switch (dice_.whole(0, 3)) {
      case 0:
        return {along_x, near};
      case 1:
        return {along_x, depth_ - near};
      case 2:
        return {near, along_y};
      default:
        return {width_ - near, along_y};
    }
  }

  void crate(int index) {
    begin(fmt::format("crate_{}", index), "box");
    const Vector3f size{dice_.uniform(0.25, 0.8), dice_.uniform(0.25, 0.6),
                        dice_.uniform(0.3, 1.5)};
    const Vector2f at = place(0.5F * size.head<2>().norm());
    const float yaw = dice_.uniform(-std::numbers::pi_v<float>, std::numbers::pi_v<float>);
    box(any_material(), {at.x(), at.y(), 0.5F * size.z()}, size, turned(yaw));
    if (dice_.whole(0, 1) == 1) {  // something on top
      const Vector3f top = size * dice_.uniform(0.3, 0.6);
      begin(fmt::format("crate_{}_top", index), "otherprop");
      box(any_material(), {at.x(), at.y(), size.z() + 0.5F * top.z()}, top, turned(yaw + 0.5F));
    }
  }

  void cylinder(std::uint16_t material, const Vector3f& base, float radius, float height) {
    const auto rim = [&](float s, float r, float z) -> Vector3f {
      const float turn =
          -2.0F * std::numbers::pi_v<float> * s;  // images read left to right from outside
      return base + Vector3f(r * std::cos(turn), -r * std::sin(turn), z);
    };
    sheet(
        material, {2 * std::numbers::pi_v<float> * radius, height},
        [&](float s, float t) { return rim(s, radius, height * (1 - t)); }, 16);
    sheet(
        material, {2 * std::numbers::pi_v<float> * radius, radius},
        [&](float s, float t) { return rim(s, radius * t, height); }, 16);
  }

  void drum(int index) {
    begin(fmt::format("drum_{}", index), "otherfurniture");
    const float radius = dice_.uniform(0.08, 0.35), height = dice_.uniform(0.4, 1.8);
    const Vector2f at = place(radius);
    cylinder(any_material(), {at.x(), at.y(), 0}, radius, height);
  }

  /// Boards between two uprights, with things on them.
  void rack(int index) {
    begin(fmt::format("rack_{}", index), "shelves");
    const float width = dice_.uniform(0.8, 1.6), depth = 0.35F, height = dice_.uniform(1.2, 2.1);
    const bool far_side = index % 2 == 1;
    const float y = far_side ? depth_ - 0.22F : 0.22F;
    const float x = dice_.uniform(0.5F * width + 0.1F, width_ - 0.5F * width - 0.1F);
    const Eigen::Matrix3f axes = turned(0.0F);
    const std::uint16_t material = any_material();
    const int boards = dice_.whole(3, 5);
    for (const float side : {-0.5F, 0.5F})
      box(material, {x + side * width, y, 0.5F * height}, {0.03F, depth, height}, axes);
    for (int i = 0; i < boards; ++i) {
      const float z = height * (static_cast<float>(i) + 0.2F) / static_cast<float>(boards);
      box(material, {x, y, z}, {width, depth, 0.025F}, axes);
    }
    for (int i = 0; i < boards; ++i) {
      const float z =
          height * (static_cast<float>(i) + 0.2F) / static_cast<float>(boards) + 0.0125F;
      const float room = 0.75F * height / static_cast<float>(boards);
      for (float at = -0.5F * width + 0.08F; at < 0.5F * width - 0.15F;) {
        const float size = dice_.uniform(0.05, 0.16), tall = room * dice_.uniform(0.35, 1.0);
        begin(fmt::format("rack_{}_item_{}", index, scene_.instances.size()), "otherprop");
        const Vector3f base(x + at + 0.5F * size, y + dice_.uniform(-0.06, 0.06), z);
        if (dice_.whole(0, 2) == 0)
          cylinder(any_material(), base, 0.5F * size, tall);
        else
          box_item(base, size, tall);
        at += size + dice_.uniform(0.02, 0.12);
      }
    }
  }

  void box_item(const Vector3f& base, float width, float tall) {
    const float deep = dice_.uniform(0.05, 0.2), yaw = dice_.uniform(-0.3, 0.3);
    box(any_material(), base + Vector3f(0, 0, 0.5F * tall), {width, deep, tall}, turned(yaw));
  }

  /// A plate that leans.
  void slab(int index) {
    begin(fmt::format("slab_{}", index), "otherfurniture");
    const Vector3f size{dice_.uniform(0.5, 1.1), 0.04F, dice_.uniform(0.6, 1.4)};
    const Vector2f at = place(0.5F * size.x());
    const float yaw = dice_.uniform(-std::numbers::pi_v<float>, std::numbers::pi_v<float>),
                lean = dice_.uniform(0.1, 0.5);
    const Eigen::Matrix3f axes =
        turned(yaw) * Eigen::AngleAxisf(lean, Vector3f::UnitX()).toRotationMatrix();
    box(any_material(), {at.x(), at.y(), 0.5F * size.z()}, size, axes);
  }

  void lamps() {
    for (int i = 0, count = dice_.whole(2, 3); i < count; ++i) {
      Light lamp;
      lamp.position_m = {dice_.uniform(0.8, width_ - 0.8), dice_.uniform(0.8, depth_ - 0.8),
                         height_ - dice_.uniform(0.15, 0.5)};
      lamp.radius_m = dice_.uniform(0.05, 0.15);
      const float power = dice_.uniform(4.0, 7.0), warmth = dice_.uniform(0.6, 1.0);
      lamp.color = {power, power * (0.5F + 0.5F * warmth), power * warmth};
      scene_.lights.push_back(lamp);
    }
  }

  void measure() {
    for (Instance& instance : scene_.instances) {
      instance.min_m.setConstant(std::numeric_limits<float>::infinity());
      instance.max_m = -instance.min_m;
    }
    for (std::size_t f = 0; f < scene_.triangles.size(); ++f) {
      Instance& instance = scene_.instances[scene_.instance_of[f] - 1U];
      for (const std::uint32_t v : scene_.triangles[f]) {
        instance.min_m = instance.min_m.cwiseMin(scene_.positions_m[v]);
        instance.max_m = instance.max_m.cwiseMax(scene_.positions_m[v]);
      }
    }
  }

  Dice dice_;
  Scene scene_;
  float width_ = 0, depth_ = 0, height_ = 0;
};

bool is_shell(const Instance& instance) {
  const std::string_view name = classes()[instance.class_id].name;
  return name == "wall" || name == "floor" || name == "ceiling";
}

bool is_free(const Scene& scene, const Vector3f& point, float clearance_m) {
  return std::ranges::none_of(scene.instances, [&](const Instance& instance) {
    if (is_shell(instance)) return false;
    const Vector3f nearest = point.cwiseMax(instance.min_m).cwiseMin(instance.max_m);
    return (point - nearest).norm() < clearance_m;
  });
}

/// Camera axes (x right, y down, z forward) in a z-up world.
SE3 look(const Vector3f& from, float yaw_rad, float pitch_rad, float roll_rad) {
  const double yaw = yaw_rad, pitch = pitch_rad;
  const Eigen::Vector3d forward(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                                std::sin(pitch));
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d axes;
  axes << right, forward.cross(right), forward;
  const Eigen::Matrix3d roll =
      Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return {axes * roll, from.cast<double>()};
}

}  // namespace

Scene make_training_room(std::uint64_t seed) {
  return RoomMaker(seed).make();
}

std::vector<SE3> training_views(const Scene& scene, std::uint64_t seed, int count) {
  constexpr float kClearance = 0.3F, kOutlook = 1.3F;
  if (scene.rooms.empty()) throw InputError(fmt::format("scene {}: has no room", scene.name));
  Eigen::AlignedBox2d outline;
  for (const Eigen::Vector2d& corner : scene.rooms[0].polygon_m) outline.extend(corner);
  const auto inside = [&](const Vector3f& p, double margin) {
    return p.x() > outline.min().x() + margin && p.x() < outline.max().x() - margin &&
           p.y() > outline.min().y() + margin && p.y() < outline.max().y() - margin;
  };
  Dice dice(RandomStream(seed).fork(0x7669));
  std::vector<SE3> views;
  for (int tries = 0; static_cast<int>(views.size()) < count; ++tries) {
    if (tries > 1000 * (count + 1))
      throw InputError(fmt::format("scene {}: no free place for a camera", scene.name));
    const Vector3f from{dice.uniform(outline.min().x(), outline.max().x()),
                        dice.uniform(outline.min().y(), outline.max().y()), dice.uniform(0.8, 1.6)};
    const float yaw = dice.uniform(-std::numbers::pi_v<float>, std::numbers::pi_v<float>),
                pitch = dice.uniform(-0.45, 0.25);
    const float roll = dice.uniform(-0.1, 0.1);
    const Vector3f ahead = from + kOutlook * Vector3f(std::cos(yaw), std::sin(yaw), 0);
    if (!inside(from, kClearance) || !inside(ahead, 0.0)) continue;
    if (!is_free(scene, from, kClearance)) continue;
    views.push_back(look(from, yaw, pitch, roll));
  }
  return views;
}

}  // namespace mh
