// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include "robots/model/robot.hpp"
#include "scenes/scene.hpp"

namespace mh {

/// Where the base is and how it moves. World frame; heading counted from world x, in (-pi, pi].
struct BaseState {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  double heading_rad = 0.0;
  Eigen::Vector2d velocity_m_per_s = Eigen::Vector2d::Zero();
  double turn_rad_per_s = 0.0;
};

/// The velocity that the base should have, world frame.
struct BaseCommand {
  Eigen::Vector2d velocity_m_per_s = Eigen::Vector2d::Zero();
  double turn_rad_per_s = 0.0;
};

/// Somebody or something upright that moves by itself: a cylinder on a path.
struct MovingObstacle {
  double radius_m = 0.22, height_m = 1.72;
  InstanceId instance = 0;                             ///< reported where it is touched
  std::function<Eigen::Vector2d(double time_s)> path;  ///< where it stands, world
};

struct Contact {
  bool touching = false;       ///< nearer to something than kTouch_m
  double penetration_m = 0.0;  ///< depth of the deepest overlap, 0 = none
  InstanceId instance = 0;     ///< what is touched (the deepest, if several)
  /// Where on the base it is: direction from its middle, world; 0 where nothing is touched.
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();
};

/// Closer than this counts as touching: Bullet holds a pressed body a hair away from the wall.
inline constexpr double kTouch_m = 5e-4;

/// What commands have to keep to so that the base that Bullet moves keeps to `limits`: a hair less
/// of the velocities, which it would cut off by a jerk, a hundredth less of the accelerations and a
/// twentieth less of the jerks, since it holds velocities in single precision (near 0.5 m/s and at
/// 240 steps per second that is a noise of 0.02 m/s^3).
BaseLimits commandable(BaseLimits limits);

/// A robot's base in a scene, moved by Bullet: a rigid upright cylinder that slides on the floor
/// and turns about its axis; walls and furniture stop it by their outline from above. It is driven
/// by impulses whose size respects BaseLimits, so that its velocity and (contacts apart)
/// acceleration never exceed them. What lies wholly within the floor's roughness (3 cm) or above
/// the robot's head is no obstacle. Deterministic: the same steps give the same bits.
class PlanarWorld {
 public:
  /// @pre the scene's floor is z = 0 (LevelScene)
  /// @param step_s duration of one step; contacts stay shallow for steps up to 1/200 s.
  PlanarWorld(const Scene& scene, const Robot& robot, const Eigen::Vector2d& start_m,
              double start_heading_rad, double step_s = 1.0 / 240.0);
  ~PlanarWorld();
  PlanarWorld(const PlanarWorld&) = delete;
  PlanarWorld& operator=(const PlanarWorld&) = delete;

  /// Accelerates towards the command as far as the limits allow, and moves on by one step.
  Contact step(const BaseCommand& command);
  BaseState state() const;
  /// What the base touches where it stands now; what crosses its axis counts as overlapping by the
  /// whole footprint radius.
  Contact contact();
  double step_s() const;

  /// Puts the base somewhere else, at rest.
  void place(const Eigen::Vector2d& position_m, double heading_rad);
  /// Adds a moving obstacle. It pushes the base, and nothing stops it.
  void add(MovingObstacle obstacle);
  /// Puts the moving obstacles where they are at a time; steps go on from there.
  void show_at(double time_s);
  /// Distance (m) along a ray, world frame, to the first thing between floor and head that is not
  /// the robot; nothing within the range if there is none.
  /// @param direction  unit
  std::optional<double> cast(const Eigen::Vector3d& from_m, const Eigen::Vector3d& direction,
                             double range_m) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mh
