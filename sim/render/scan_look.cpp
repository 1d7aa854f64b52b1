// SPDX-License-Identifier: Apache-2.0
#include "sim/render/scan_look.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "scenes/materials/noise.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Eigen::Vector3i;

struct Voxel {
  float distance_m = 0;  ///< mean signed distance along the ray, positive before the surface
  std::uint16_t views = 0;
  InstanceId instance = 0;
  std::uint8_t votes = 0;  ///< lead of that instance over others (Boyer-Moore majority vote)
  std::array<float, 3> color{};
};

/// Bounding box of what the views see, meters.
struct Bounds {
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
};

class Volume {
 public:
  Volume(const Bounds& bounds, const ScanLookConfig& config)
      : config_(config), low_(bounds.low - Vector3d::Constant(2 * config.band_m)) {
    const Vector3d span = bounds.high + Vector3d::Constant(2 * config.band_m) - low_;
    size_ = (span / config.voxel_m).array().ceil().cast<int>().matrix() + Vector3i::Ones();
    const double count = size_.cast<double>().prod();
    constexpr double kMost = 6e8;
    if (count > kMost)
      throw InputError(
          fmt::format("scan look: {:.0f} voxels of {} m are too many; a scene of {:.1f} "
                      "x {:.1f} x {:.1f} m needs coarser ones",
                      count, config.voxel_m, span.x(), span.y(), span.z()));
    voxels_.resize(static_cast<std::size_t>(count));
  }

  void add(const RenderedFrame& frame, const Camera& camera, const SE3& world_from_camera,
           RandomStream random) {
    // Smooth depth errors, different for each view.
    const Field bumps = fbm(camera.width_px, camera.height_px, {6, 5, 3, 0.6F}, random);
    for (int y = 0; y < camera.height_px; ++y)
      for (int x = 0; x < camera.width_px; ++x) {
        const double seen = static_cast<double>(frame.depth_m(x, y));
        if (seen <= 0) continue;
        const double depth =
            seen + config_.bump_m * static_cast<double>(bumps(x, y)) * (seen / 2) * (seen / 2);
        const Vector3d ray = world_from_camera.rotation() * camera.unproject(x, y, 1.0);
        const double per_depth = ray.norm(), step = 0.5 * config_.voxel_m / per_depth;
        Vector3i last = Vector3i::Constant(-1);
        for (double d = depth - config_.band_m / per_depth; d <= depth + config_.band_m / per_depth;
             d += step) {
          const Vector3i at = cell_of(world_from_camera.translation() + d * ray);
          if (at == last || !holds(at)) continue;
          last = at;
          // To the middle of the voxel, along the ray.
          const Vector3d middle = center_of(at) - world_from_camera.translation();
          const double along = middle.dot(ray) / (per_depth * per_depth);
          update(voxels_[index(at)], (depth - along) * per_depth, frame.color(x, y),
                 frame.instances(x, y));
        }
      }
  }

  /// One vertex in each cell that the surface crosses, one face for each edge that it crosses.
  void mesh_into(Scene& out) const {
    std::vector<std::uint32_t> vertex_of(voxels_.size(), kNone);
    std::vector<InstanceId> owner;
    for (int z = 0; z + 1 < size_.z(); ++z)
      for (int y = 0; y + 1 < size_.y(); ++y)
        for (int x = 0; x + 1 < size_.x(); ++x) add_vertex({x, y, z}, vertex_of, owner, out);
    for (int z = 1; z + 1 < size_.z(); ++z)
      for (int y = 1; y + 1 < size_.y(); ++y)
        for (int x = 1; x + 1 < size_.x(); ++x)
          for (int axis = 0; axis < 3; ++axis) add_face({x, y, z}, axis, vertex_of, owner, out);
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  Vector3i cell_of(const Vector3d& p) const {
    return ((p - low_) / config_.voxel_m).array().floor().cast<int>().matrix();
  }
  Vector3d center_of(const Vector3i& cell) const {
    return low_ + config_.voxel_m * (cell.cast<double>() + Vector3d::Constant(0.5));
  }
  bool holds(const Vector3i& c) const {
    return c.minCoeff() >= 0 && (c.array() < size_.array()).all();
  }
  std::size_t index(const Vector3i& c) const {
    return static_cast<std::size_t>(c.x()) +
           static_cast<std::size_t>(size_.x()) *
               (static_cast<std::size_t>(c.y()) +
                static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(c.z()));
  }
  bool known(const Voxel& v) const { return v.views >= config_.least_views; }

  void update(Voxel& v, double distance_m, Rgb8 color, InstanceId instance) const {
    if (v.views == std::numeric_limits<std::uint16_t>::max()) return;
    const float share = 1.0F / static_cast<float>(++v.views);
    v.distance_m += share * (static_cast<float>(distance_m) - v.distance_m);
    const std::array<float, 3> c = {static_cast<float>(color.r), static_cast<float>(color.g),
                                    static_cast<float>(color.b)};
    for (std::size_t k = 0; k < 3; ++k) v.color[k] += share * (c[k] - v.color[k]);
    if (v.votes == 0) v.instance = instance;
    if (v.instance == instance)
      v.votes = static_cast<std::uint8_t>(std::min(255, v.votes + 1));
    else
      --v.votes;
  }

  void add_vertex(const Vector3i& cell, std::vector<std::uint32_t>& vertex_of,
                  std::vector<InstanceId>& owner, Scene& out) const {
    std::array<const Voxel*, 8> corner{};
    int inside = 0;
    for (int k = 0; k < 8; ++k) {
      const Voxel& v = voxels_[index(cell + offset(k))];
      if (!known(v)) return;
      corner[static_cast<std::size_t>(k)] = &v;
      inside += v.distance_m < 0;
    }
    if (inside == 0 || inside == 8) return;
    Vector3d sum = Vector3d::Zero();
    int crossings = 0;
    for (int a = 0; a < 8; ++a)
      for (const int axis : {1, 2, 4}) {
        if (a & axis) continue;
        const int b = a | axis;
        const float da = corner[static_cast<std::size_t>(a)]->distance_m,
                    db = corner[static_cast<std::size_t>(b)]->distance_m;
        if ((da < 0) == (db < 0)) continue;
        const double t = static_cast<double>(da / (da - db));
        sum += (1 - t) * offset(a).cast<double>() + t * offset(b).cast<double>();
        ++crossings;
      }
    // Color and object are those of the voxel nearest to the surface.
    const Voxel& nearest = **std::ranges::min_element(
        corner, {}, [](const Voxel* v) { return std::abs(v->distance_m); });
    vertex_of[index(cell)] = static_cast<std::uint32_t>(out.positions_m.size());
    out.positions_m.push_back((center_of(cell) + config_.voxel_m * sum / crossings).cast<float>());
    const auto level = [](float c) { return static_cast<std::uint8_t>(std::lround(c)); };
    out.colors.push_back(
        {level(nearest.color[0]), level(nearest.color[1]), level(nearest.color[2])});
    owner.push_back(nearest.instance);
  }

  void add_face(const Vector3i& at, int axis, const std::vector<std::uint32_t>& vertex_of,
                const std::vector<InstanceId>& owner, Scene& out) const {
    const Voxel &a = voxels_[index(at)], &b = voxels_[index(at + Vector3i::Unit(axis))];
    if (!known(a) || !known(b) || (a.distance_m < 0) == (b.distance_m < 0)) return;
    // Far behind a surface, the sign flips again at the end of another view's band: that is not a
    // surface.
    if (std::abs(a.distance_m - b.distance_m) > 2.5 * config_.voxel_m) return;
    const Vector3i u = Vector3i::Unit((axis + 1) % 3), v = Vector3i::Unit((axis + 2) % 3);
    std::array<std::uint32_t, 4> q{};
    const std::array<Vector3i, 4> cells = {at - u - v, at - v, at, at - u};
    for (std::size_t k = 0; k < 4; ++k) {
      q[k] = vertex_of[index(cells[k])];
      if (q[k] == kNone) return;
    }
    if (a.distance_m > 0) std::swap(q[1], q[3]);  // faces point toward the views that saw them
    for (const auto& t : {std::array{q[0], q[2], q[1]}, std::array{q[0], q[3], q[2]}}) {
      out.triangles.push_back(t);
      out.instance_of.push_back(owner[t[0]]);
    }
  }

  static Vector3i offset(int corner) { return {corner & 1, (corner >> 1) & 1, (corner >> 2) & 1}; }

  const ScanLookConfig config_;
  Vector3d low_;
  Vector3i size_;
  std::vector<Voxel> voxels_;
};

/// Computes the boxes of the objects as scanned; those that no view saw are left out.
void measure(const Scene& source, Scene& out) {
  for (Instance instance : source.instances) {
    instance.min_m.setConstant(std::numeric_limits<float>::infinity());
    instance.max_m = -instance.min_m;
    for (std::size_t f = 0; f < out.triangles.size(); ++f) {
      if (out.instance_of[f] != instance.id) continue;
      for (const std::uint32_t v : out.triangles[f]) {
        instance.min_m = instance.min_m.cwiseMin(out.positions_m[v]);
        instance.max_m = instance.max_m.cwiseMax(out.positions_m[v]);
      }
    }
    if (instance.min_m.x() <= instance.max_m.x()) out.instances.push_back(instance);
  }
}

}  // namespace

Scene scan_look(const Scene& scene, const Renderer& renderer, const Camera& camera,
                std::span<const SE3> world_from_camera, const ScanLookConfig& config) {
  if (config.voxel_m < 0.005 || config.voxel_m > 0.1 || config.band_m < 2 * config.voxel_m)
    throw InputError(
        fmt::format("scan look: voxels of {} m in a band of {} m: voxels must be 0.005 to 0.1 m, "
                    "the band at least twice that",
                    config.voxel_m, config.band_m));
  if (world_from_camera.empty()) throw InputError("scan look: there are no views");
  const auto each_point = [&](const RenderedFrame& frame, const SE3& pose, const auto& use) {
    for (int y = 0; y < camera.height_px; y += 4)
      for (int x = 0; x < camera.width_px; x += 4)
        if (frame.depth_m(x, y) > 0)
          use(pose * camera.unproject(x, y, static_cast<double>(frame.depth_m(x, y))));
  };
  // Nothing outside the scene's rooms is scanned, such as what is seen through windows.
  Bounds rooms, seen;
  for (const Room& room : scene.rooms)
    for (const Eigen::Vector2d& p : room.polygon_m) {
      rooms.low.head<2>() = rooms.low.head<2>().cwiseMin(p);
      rooms.high.head<2>() = rooms.high.head<2>().cwiseMax(p);
    }
  std::vector<RenderedFrame> frames;
  for (const SE3& pose : world_from_camera) {
    frames.push_back(renderer.render(camera, pose));
    each_point(frames.back(), pose, [&](const Vector3d& p) {
      const auto flat = p.head<2>().array();
      if (!scene.rooms.empty() && ((flat < rooms.low.head<2>().array() - 0.2).any() ||
                                   (flat > rooms.high.head<2>().array() + 0.2).any()))
        return;
      seen.low = seen.low.cwiseMin(p);
      seen.high = seen.high.cwiseMax(p);
    });
  }
  if (!(seen.low.x() <= seen.high.x())) throw InputError("scan look: the views see nothing");
  Volume volume(seen, config);
  for (std::size_t i = 0; i < frames.size(); ++i)
    volume.add(frames[i], camera, world_from_camera[i], RandomStream(config.seed).fork(i));

  Scene out;
  out.name = scene.name;
  out.rooms = scene.rooms;
  out.materials.push_back({.name = "scan", .base_color = {255, 255, 255}, .texture = {}});
  volume.mesh_into(out);
  out.material_of.assign(out.triangles.size(), 0);
  std::vector<ClassId> class_of(std::size_t{1} << 16, kVoid);
  for (const Instance& instance : scene.instances) class_of[instance.id] = instance.class_id;
  for (const InstanceId id : out.instance_of) out.class_of.push_back(class_of[id]);
  measure(scene, out);
  validate(out);
  return out;
}

}  // namespace mh
