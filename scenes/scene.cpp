// SPDX-License-Identifier: Apache-2.0
#include "scenes/scene.hpp"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <type_traits>

#include "slam/io/error.hpp"

namespace mh {
namespace {

/// Beyond this, single precision cannot resolve a meter, and ray tracers fail.
constexpr float kFarthest_m = 1e7F;

double polygon_area_m2(const std::vector<Eigen::Vector2d>& polygon_m) {
  double doubled = 0.0;
  for (std::size_t i = 0; i < polygon_m.size(); ++i) {
    const Eigen::Vector2d& a = polygon_m[i];
    const Eigen::Vector2d& b = polygon_m[(i + 1) % polygon_m.size()];
    doubled += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * doubled;
}

/// Throws "scene NAME: what" for the first inconsistency.
class Checker {
 public:
  explicit Checker(const Scene& scene) : scene_(scene) {}

  void run() const {
    check_sizes();
    check_vertices();
    check_materials();
    check_instances();
    check_faces();
  }

 private:
  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError(
        fmt::format("scene {}: {}", scene_.name, fmt::format(format, std::forward<Args>(args)...)));
  }

  void same_size(std::size_t size, std::size_t wanted, const char* what) const {
    if (size != wanted) fail("{} has {} elements instead of {}", what, size, wanted);
  }

  void check_sizes() const {
    const std::size_t vertices = scene_.positions_m.size();
    if (!scene_.uvs.empty()) same_size(scene_.uvs.size(), vertices, "uvs");
    if (!scene_.colors.empty()) same_size(scene_.colors.size(), vertices, "colors");
    if (!scene_.light.empty()) same_size(scene_.light.size(), vertices, "light");
    const std::size_t faces = scene_.triangles.size();
    same_size(scene_.material_of.size(), faces, "material_of");
    same_size(scene_.class_of.size(), faces, "class_of");
    same_size(scene_.instance_of.size(), faces, "instance_of");
  }

  void check_vertices() const {
    for (std::size_t i = 0; i < scene_.positions_m.size(); ++i)
      if (!scene_.positions_m[i].allFinite())
        fail("vertex {}: position is not finite", i);
      else if (const float far_m = scene_.positions_m[i].cwiseAbs().maxCoeff(); far_m > kFarthest_m)
        fail("vertex {}: lies {:g} m from the origin", i, far_m);
    for (std::size_t i = 0; i < scene_.uvs.size(); ++i)
      if (!scene_.uvs[i].allFinite()) fail("vertex {}: texture coordinate is not finite", i);
    for (std::size_t i = 0; i < scene_.light.size(); ++i)
      if (!scene_.light[i].allFinite() || scene_.light[i].minCoeff() < 0.0F)
        fail("vertex {}: light is negative or not finite", i);
  }

  void check_materials() const {
    for (const Material& material : scene_.materials) {
      if (!material.texture.empty() && scene_.uvs.empty())
        fail("material {}: has a texture, but the scene has no uvs", material.name);
      if (!material.opacity.empty() && (material.opacity.width() != material.texture.width() ||
                                        material.opacity.height() != material.texture.height()))
        fail("material {}: opacity must be as large as the texture", material.name);
      if (!(material.tile_m.minCoeff() > 0.0F) || !material.tile_m.allFinite())
        fail("material {}: tile_m must be positive, is {} x {}", material.name, material.tile_m.x(),
             material.tile_m.y());
      if (!material.emission.allFinite() || material.emission.minCoeff() < 0.0F)
        fail("material {}: emission is negative or not finite", material.name);
      if (!(material.transmission.minCoeff() >= 0.0F && material.transmission.maxCoeff() <= 1.0F))
        fail("material {}: transmission must be 0 to 1", material.name);
    }
  }

  void check_instances() const {
    std::set<std::string> names;
    InstanceId last = 0;
    for (const Instance& instance : scene_.instances) {
      if (instance.id <= last)
        fail("instance {}: id {} does not follow {}", instance.name, instance.id, last);
      last = instance.id;
      if (instance.class_id >= classes().size())
        fail("instance {}: unknown class {}", instance.name, instance.class_id);
      if (!names.insert(instance.name).second)
        fail("instance {}: name is not unique", instance.name);
    }
  }

  void check_faces() const {
    std::vector<bool> known(65536, false);
    known[0] = true;
    for (const Instance& instance : scene_.instances) known[instance.id] = true;
    for (std::size_t i = 0; i < scene_.triangles.size(); ++i) {
      for (const std::uint32_t vertex : scene_.triangles[i])
        if (vertex >= scene_.positions_m.size()) fail("face {}: no vertex {}", i, vertex);
      if (scene_.material_of[i] >= scene_.materials.size())
        fail("face {}: no material {}", i, scene_.material_of[i]);
      if (scene_.class_of[i] >= classes().size())
        fail("face {}: no class {}", i, scene_.class_of[i]);
      if (!known[scene_.instance_of[i]]) fail("face {}: no instance {}", i, scene_.instance_of[i]);
    }
  }

  const Scene& scene_;
};

/// Chains XXH3 over values and arrays; sizes are hashed too, so that equal bytes split differently
/// between arrays give different digests.
class Digest {
 public:
  template <class T>
  void value(const T& item) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>);
    bytes(&item, sizeof item);
  }
  template <class T>
  void array(const T* items, std::size_t count) {
    value(static_cast<std::uint64_t>(count));
    bytes(items, count * sizeof(T));
  }
  template <class Container>
  void array(const Container& items) {
    array(items.data(), items.size());
  }
  void vector(const Eigen::Vector3f& v) { bytes(v.data(), 3 * sizeof(float)); }
  std::uint64_t result() const { return state_; }

 private:
  void bytes(const void* data, std::size_t size) {
    state_ = XXH3_64bits_withSeed(data, size, state_);
  }
  std::uint64_t state_ = 0x6d68;
};

}  // namespace

bool Room::contains(const Eigen::Vector2d& place_m) const {
  bool inside = false;
  for (std::size_t i = 0, j = polygon_m.size() - 1; i < polygon_m.size(); j = i++) {
    const Eigen::Vector2d &a = polygon_m[i], &b = polygon_m[j];
    if ((a.y() > place_m.y()) != (b.y() > place_m.y()) &&
        place_m.x() < (b.x() - a.x()) * (place_m.y() - a.y()) / (b.y() - a.y()) + a.x())
      inside = !inside;
  }
  return inside;
}

double Scene::floor_area_m2() const {
  const bool planned = !rooms.empty() && !std::ranges::any_of(rooms, &Room::is_box);
  if (floor.area_m2 && !planned) return *floor.area_m2;
  double sum = 0.0;
  for (const Room& room : rooms) sum += polygon_area_m2(room.polygon_m);
  return sum;
}

void validate(const Scene& scene) {
  Checker(scene).run();
}

std::uint64_t digest(const Scene& scene) {
  static_assert(sizeof(Eigen::Vector3f) == 12 && sizeof(Eigen::Vector2f) == 8 && sizeof(Rgb8) == 3);
  Digest all;
  all.array(scene.positions_m);
  all.array(scene.uvs);
  all.array(scene.colors);
  all.array(scene.light);
  all.array(scene.triangles);
  all.array(scene.material_of);
  all.array(scene.class_of);
  all.array(scene.instance_of);
  for (const Material& material : scene.materials) {
    all.value(material.base_color);
    all.value(material.texture.width());
    all.array(material.texture.data(), material.texture.size());
    all.vector(material.emission);
    if (!material.opacity.empty()) all.array(material.opacity.data(), material.opacity.size());
    if (material.is_pane()) all.vector(material.transmission);
  }
  for (const Instance& instance : scene.instances) {
    all.value(instance.id);
    all.value(instance.class_id);
  }
  for (const Light& light : scene.lights) {
    all.value(light.kind);
    all.vector(light.position_m);
    all.vector(light.direction);
    all.value(light.radius_m);
    all.value(light.angular_radius_rad);
    all.vector(light.color);
  }
  return all.result();
}

}  // namespace mh
