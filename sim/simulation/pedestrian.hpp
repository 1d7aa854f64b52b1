// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "scenes/scene.hpp"
#include "sim/render/renderer.hpp"

namespace mh {

/// A person who walks back and forth along a line of places.
struct Pedestrian {
  std::vector<Eigen::Vector2d> path_m;  ///< two places or more, world
  double speed_m_per_s = 1.2;           ///< above 0
  double start_s = 0;                   ///< time at which the pedestrian leaves the first place
};

/// Reads a pedestrian (YAML): `path: [[x, y], ...]`, optional `speed_m_per_s`, `start_s`.
/// @throws InputError naming file, line, field and value.
Pedestrian load_pedestrian(const std::filesystem::path& file);

/// Pose of the pedestrian, facing the direction of travel: x forward, z up, origin on the floor.
SE3 world_from_pedestrian(const Pedestrian& pedestrian, Stamp stamp_ns);

/// Builds the pedestrian's body in its own frame: 1.72 m tall, at most 0.22 m from its axis; one
/// instance of class `person`. A capsule with a head, pants and a knitted sweater, no limbs.
/// @param light  light on a vertical surface, irradiance / pi, linear RGB
Scene build_pedestrian(const Eigen::Vector3f& light);
inline constexpr double kPedestrianRadius_m = 0.22;
inline constexpr double kPedestrianHeight_m = 1.72;

/// The pedestrian's instance in a scene: one above the scene's last instance.
InstanceId pedestrian_instance(const Scene& scene);

/// A scene with a pedestrian on its floor. The two are rendered separately and merged by depth, so
/// the pedestrian occludes what is behind and is occluded by what is in front; a pedestrian casts
/// no shadow and is lit by the scene's mean light, not by the light at its place.
class PedestrianScene {
 public:
  /// @param scene     the scene of `renderer`; its mean light lights the pedestrian
  /// @param exposure  that of `renderer`
  PedestrianScene(const Scene& scene, std::shared_ptr<const Renderer> renderer, float exposure,
                  Pedestrian pedestrian);
  ~PedestrianScene();
  PedestrianScene(const PedestrianScene&) = delete;
  PedestrianScene& operator=(const PedestrianScene&) = delete;

  /// The scene as it is at a given time. Must not outlive this.
  std::shared_ptr<const Renderer> at(Stamp stamp_ns) const;
  const Pedestrian& pedestrian() const { return pedestrian_; }

 private:
  std::shared_ptr<const Renderer> scene_;
  std::unique_ptr<const Renderer> body_;
  InstanceId instance_;    ///< the pedestrian's
  Pedestrian pedestrian_;  ///< in the floor's frame
  SE3 world_from_floor_;
};

}  // namespace mh
