// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "scenes/scene.hpp"
#include "sim/render/renderer.hpp"

namespace mh {

/// A person who walks to and fro along a line of places.
struct Walk {
  std::vector<Eigen::Vector2d> path_m;  ///< two places or more, world
  double speed_m_per_s = 1.2;           ///< above 0
  double start_s = 0;                   ///< when he sets off; he waits in the first place till then
};

/// Reads a walk (YAML): `path: [[x, y], ...]`, optional `speed_m_per_s`, `start_s`.
/// @throws InputError naming file, line, field and value.
Walk load_walk(const std::filesystem::path& file);

/// Where the walker stands, facing the way he goes: x forward, z up, origin on the floor.
SE3 world_from_walker(const Walk& walk, Stamp stamp_ns);

/// The walker's body in his own frame: 1.72 m high, at most 0.22 m from his middle; one instance
/// of class `person`. A capsule with a head, trousers and a knitted pullover, no limbs.
/// @param light  what reaches an upright surface, irradiance / pi, linear RGB
Scene build_walker(const Eigen::Vector3f& light);
inline constexpr double kWalkerRadius_m = 0.22;
inline constexpr double kWalkerHeight_m = 1.72;

/// The walker's instance in a scene: one above its own.
InstanceId walker_instance(const Scene& scene);

/// A scene with somebody walking over its floor. The two are rendered apart and merged by depth, so
/// the walker hides what is behind him and is hidden by what is before him; he casts no shadow and
/// takes no light from the place where he stands, but the scene's mean.
class WalkedScene {
 public:
  /// @param scene     what `renderer` shows; its mean light is the walker's
  /// @param exposure  that of `renderer`
  WalkedScene(const Scene& scene, std::shared_ptr<const Renderer> renderer, float exposure,
              Walk walk);
  ~WalkedScene();
  WalkedScene(const WalkedScene&) = delete;
  WalkedScene& operator=(const WalkedScene&) = delete;

  /// The scene as it is at one moment. Must not outlive this.
  std::shared_ptr<const Renderer> at(Stamp stamp_ns) const;
  const Walk& walk() const { return walk_; }

 private:
  std::shared_ptr<const Renderer> scene_;
  std::unique_ptr<const Renderer> walker_;
  InstanceId instance_;  ///< the walker's
  Walk walk_;            ///< in the floor's frame
  SE3 world_from_floor_;
};

}  // namespace mh
