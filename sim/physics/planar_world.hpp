// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include "robots/model/robot.hpp"
#include "scenes/scene.hpp"

namespace mh {

/// Minimum number of physics steps per second.
inline constexpr double kStepRate_hz = 240.0;

/// Pose and velocity of the base. World frame; heading measured from world x, in (-pi, pi].
struct BaseState {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  double heading_rad = 0.0;
  Eigen::Vector2d velocity_m_per_s = Eigen::Vector2d::Zero();
  double turn_rad_per_s = 0.0;
};

/// The commanded velocity of the base, world frame.
struct BaseCommand {
  Eigen::Vector2d velocity_m_per_s = Eigen::Vector2d::Zero();
  double turn_rad_per_s = 0.0;
};

/// An upright obstacle that moves by itself, such as a pedestrian: a cylinder on a path.
struct MovingObstacle {
  double radius_m = 0.22, height_m = 1.72;
  InstanceId instance = 0;                             ///< reported when it is touched
  std::function<Eigen::Vector2d(double time_s)> path;  ///< its position, world
};

struct Contact {
  bool touching = false;       ///< something is nearer than kTouch_m
  double penetration_m = 0.0;  ///< depth of the deepest overlap, 0 = none
  InstanceId instance = 0;     ///< what is touched (the deepest contact, if several)
  /// Direction of the contact from the base's center, world; 0 if nothing is touched.
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();
};

/// Closer than this is treated as touching: Bullet keeps a pressed body slightly off the wall.
inline constexpr double kTouch_m = 5e-4;

/// Limits on commands that keep the base, as Bullet moves it, within `limits`: velocities slightly
/// lower, since clamping them would be a jerk; accelerations 1/100 lower and jerks 1/20 lower,
/// since Bullet stores velocities in single precision (near 0.5 m/s at 240 steps per second, that
/// is a noise of 0.02 m/s^3).
BaseLimits commandable(BaseLimits limits);

/// A robot's base in a scene, moved by Bullet: a rigid upright cylinder that slides on the floor
/// and turns about its axis; it collides with the outlines of walls and furniture as seen from
/// above. It is driven by impulses limited by BaseLimits, so that its velocity and (except in
/// contacts) acceleration never exceed them. For a differential base, they limit only motion ahead
/// and back, since in a bend the grip of the wheels, not the motors, provides the lateral
/// acceleration. What is entirely within the floor's roughness (3 cm) or above the robot's head is
/// not an obstacle. Deterministic: the same steps give the same bits.
class PlanarWorld {
 public:
  /// @pre the scene's floor is z = 0 (LevelScene)
  /// @param step_s  duration of one step; contacts stay shallow for steps up to 1/200 s.
  PlanarWorld(const Scene& scene, const Robot& robot, const Eigen::Vector2d& start_m,
              double start_heading_rad, double step_s = 1.0 / kStepRate_hz);
  ~PlanarWorld();
  PlanarWorld(const PlanarWorld&) = delete;
  PlanarWorld& operator=(const PlanarWorld&) = delete;

  /// Accelerates toward the command within the limits and advances by one step.
  Contact step(const BaseCommand& command);
  BaseState state() const;
  /// Returns what the base touches at its current place. Anything that crosses the vertical axis of
  /// the base counts as an overlap by the whole footprint radius.
  Contact contact();
  double step_s() const;

  /// Moves the base to another place, at rest.
  void place(const Eigen::Vector2d& position_m, double heading_rad);
  /// Adds a moving obstacle. It pushes the base, and nothing stops it.
  void add(MovingObstacle obstacle);
  /// Moves the obstacles to their positions at a time; steps continue from there.
  void show_at(double time_s);
  /// Returns the distance (m) along a ray, world frame, to the first thing between floor and head
  /// that is not the robot; nullopt if there is none within the range.
  /// @param direction  unit
  std::optional<double> cast(const Eigen::Vector3d& from_m, const Eigen::Vector3d& direction,
                             double range_m) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mh
