// SPDX-License-Identifier: Apache-2.0
#include "bench/report/drawing/viewpoints.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <tuple>

#include "bench/report/drawing/contact_sheet.hpp"
#include "robots/navigation/plan.hpp"
#include "scenes/floor.hpp"
#include "sim/motion/floor_grid.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kEye_m = 1.45;  // eyes of a sitting person or standing child
constexpr double kHead_m = 1.9;
constexpr std::size_t kTargets = 24;
constexpr std::size_t kPlaces = 10;
constexpr int kDirections = 8;

double direction_rad(int k) {
  return 2 * std::numbers::pi * k / kDirections;
}

bool is_bare(ClassId id) {
  static const std::array bare = {class_by_name("wall"), class_by_name("floor"),
                                  class_by_name("ceiling")};
  return std::ranges::find(bare, std::optional(id)) != bare.end();
}

Vector2d ahead(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}

/// Something worth viewing: its place and size.
struct Target {
  Vector3d middle_m;
  double radius_m = 0;
};

/// The largest objects and, as one more target, everything above the floor.
std::vector<Target> targets_in(const Scene& level) {
  Eigen::AlignedBox3d all;
  for (std::size_t face = 0; face < level.triangles.size(); ++face)
    for (const std::uint32_t v : level.triangles[face])
      if (static_cast<double>(level.positions_m[v].z()) > level.floor.rough_m)
        all.extend(level.positions_m[v].cast<double>());
  std::vector<Target> targets;
  for (const Instance& instance : level.instances) {
    const Eigen::Vector3d size = (instance.max_m - instance.min_m).cast<double>();
    if (is_bare(instance.class_id) || size.norm() < 0.1) continue;
    targets.push_back(
        {(0.5F * (instance.min_m + instance.max_m)).cast<double>(), 0.5 * size.norm()});
  }
  std::ranges::stable_sort(targets, std::greater<>(), &Target::radius_m);
  if (targets.size() > kTargets) targets.resize(kTargets);
  if (!all.isEmpty()) targets.push_back({all.center(), 0.5 * all.diagonal().norm()});
  return targets;
}

/// Views, in the floor's frame, of a person standing on free floor.
std::vector<SE3> standing_views(const Scene& level) {
  Eigen::AlignedBox2d box;
  for (const Room& room : level.rooms)
    for (const Vector2d& corner : room.polygon_m) box.extend(corner);
  const double size_m = box.isEmpty() ? 0 : box.sizes().maxCoeff();
  FloorGrid grid;
  try {
    grid = make_floor_grid(
        level, {.resolution_m = std::clamp(size_m / 1500, 0.04, 1.0), .top_m = kHead_m});
  } catch (const InputError&) {
    return {};  // nothing to stand on
  }
  std::vector<SE3> views;
  for (const double clearance_m : {0.35, 0.2, 0.1}) {
    const Grid2d<std::uint8_t> region = largest_region(grid, clearance_m);
    if (std::ranges::count(region, 1) * grid.resolution_m * grid.resolution_m < 0.25) continue;
    const auto look = [&](const Vector2d& from, const Vector3d& to) {
      const double away_m = (to.head<2>() - from).norm();  // people do not stare at the ceiling
      const double z_m = std::clamp(to.z(), kEye_m - 0.7 * away_m, kEye_m + 0.2 * away_m);
      views.push_back(look_at({from.x(), from.y(), kEye_m}, {to.x(), to.y(), z_m}));
    };
    for (const Vector2d& place : spread_places(grid, region, 1.0, kPlaces, 0))
      for (int k = 0; k < kDirections; ++k) {
        const Vector2d to = place + ahead(direction_rad(k));
        look(place, {to.x(), to.y(), kEye_m - 0.25});
      }
    for (const Target& target : targets_in(level))
      for (int k = 0; k < kDirections; ++k) {
        const double away_m = std::clamp(1.6 * target.radius_m, 1.5, 12.0);
        const Vector2d from = target.middle_m.head<2>() + away_m * ahead(direction_rad(k));
        if (grid.clearance_at(from) >= clearance_m) look(from, target.middle_m);
      }
    break;
  }
  return views;
}

/// Views from around the whole scene, slightly from above.
std::vector<SE3> walking_around(const Scene& level) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& p : level.positions_m) box.extend(p.cast<double>());
  if (box.isEmpty()) return {SE3()};
  const double radius_m = std::max(0.05, 0.5 * box.diagonal().norm());
  std::vector<SE3> views;
  for (int k = 0; k < kDirections; ++k) {
    const Vector2d from = box.center().head<2>() + 1.7 * radius_m * ahead(direction_rad(k) + 0.3);
    views.push_back(look_at({from.x(), from.y(), box.center().z() + 0.7 * radius_m}, box.center()));
  }
  return views;
}

/// What a view shows, as sets of keys: two views that show the same thing have the same key for it.
struct Seen {
  SE3 pose;
  std::set<InstanceId> objects;
  std::set<std::array<int, 3>> surface, ground;  ///< cubes of 0.5 m
  double share = 1;  ///< of the image that is neither empty nor too close to the lens
};

Seen look(const Scene& scene, const Renderer& renderer, const Camera& camera, const SE3& pose) {
  constexpr float kNearest_m = 0.6F;
  constexpr double kCube_m = 0.5;
  const RenderedFrame frame = renderer.render(camera, pose);
  Seen seen{.pose = pose, .objects = {}, .surface = {}, .ground = {}};
  std::vector<std::size_t> pixels(65536, 0);
  std::size_t good = 0;
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      const float depth = frame.depth_m(x, y);
      if (depth < kNearest_m) continue;  // also skips empty pixels
      ++good;
      ++pixels[frame.instances(x, y)];
      if (x % 3 != 0 || y % 3 != 0) continue;
      const Vector3d p = pose * camera.unproject(x, y, static_cast<double>(depth)) / kCube_m;
      (is_walked_on(frame.classes(x, y)) ? seen.ground : seen.surface)
          .insert({static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())),
                   static_cast<int>(std::floor(p.z()))});
    }
  seen.share = static_cast<double>(good) / static_cast<double>(frame.depth_m.size());
  for (const Instance& instance : scene.instances)
    if (!is_bare(instance.class_id) && 200 * pixels[instance.id] >= frame.depth_m.size())
      seen.objects.insert(instance.id);
  return seen;
}

}  // namespace

std::vector<SE3> viewpoints(const Scene& scene, const Renderer& renderer, const Camera& camera,
                            std::size_t most) {
  const LevelScene level(scene);
  std::vector<SE3> candidates = standing_views(*level);
  if (candidates.empty()) candidates = walking_around(*level);
  constexpr double kSmall = 0.2;
  const Camera small = resized(camera, static_cast<int>(kSmall * camera.width_px),
                               static_cast<int>(kSmall * camera.height_px));
  std::vector<Seen> views;
  for (const SE3& pose : candidates)
    views.push_back(look(scene, renderer, small, level.world_from_level() * pose));

  // The value of one object and of one cube of ground; a cube of other surface has value 1.
  constexpr double kObject = 10, kGround = 0.01;
  std::vector<SE3> chosen;
  std::set<InstanceId> objects;
  std::set<std::array<int, 3>> surface, ground;
  double first_worth = 0;
  while (chosen.size() < std::min(most, views.size())) {
    const Seen* best = nullptr;
    double best_worth = -1;
    for (const Seen& view : views) {
      const auto is_new = [](const auto& known) {
        return [&known](const auto& key) { return !known.contains(key); };
      };
      const double worth =
          view.share *
          (kObject * static_cast<double>(std::ranges::count_if(view.objects, is_new(objects))) +
           static_cast<double>(std::ranges::count_if(view.surface, is_new(surface))) +
           kGround * static_cast<double>(std::ranges::count_if(view.ground, is_new(ground))));
      if (worth <= best_worth) continue;
      best_worth = worth;
      best = &view;
    }
    if (chosen.empty()) first_worth = best_worth;
    if (chosen.size() >= 2 && best_worth < 0.1 * first_worth) break;
    chosen.push_back(best->pose);
    objects.insert(best->objects.begin(), best->objects.end());
    surface.insert(best->surface.begin(), best->surface.end());
    ground.insert(best->ground.begin(), best->ground.end());
  }
  return chosen;
}

}  // namespace mh
