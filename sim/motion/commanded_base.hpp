// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "robots/model/wheel_base.hpp"
#include "sim/motion/motors.hpp"
#include "sim/motion/peaks.hpp"
#include "sim/motion/reflex.hpp"
#include "sim/physics/planar_world.hpp"

namespace mh {

/// The base began to touch something.
struct Bump {
  double time_s = 0;
  /// Speed of the robot toward what it touches; at most the speed that its wheels gave it, so that
  /// a robot that is shoved against a wall does not count as having driven there.
  double speed_m_per_s = 0;
  InstanceId instance = 0;
};

/// The base of a robot in a scene, which obeys velocity commands one physics step after another:
/// what command scripts and the Simulation have in common. Velocity, acceleration, jerk and rim
/// speed stay within the robot's limits, whatever is commanded.
class CommandedBase {
 public:
  /// @param reflex  whether the external-collision reflex is active
  /// @throws InputError if `reflex` is set but the robot has none.
  CommandedBase(const Scene& scene, const Robot& robot, const Eigen::Vector2d& start_m,
                double start_heading_rad, bool reflex);

  void add(MovingObstacle other);
  /// Sets the time that steps continue from; obstacles move to where they are then.
  void set_time(double time_s);
  /// One physics step. @param command  base frame; a differential base does not obey its second
  ///                                   component
  void step(const Twist2d& command);
  /// Lifts the robot to another place, where it stands at rest.
  void carry_to(const Eigen::Vector2d& place_m, double heading_rad);

  PlanarWorld& world() { return world_; }
  const PlanarWorld& world() const { return world_; }
  const BaseState& state() const { return state_; }
  SE3 world_from_base() const;
  const Contact& contact() const { return contact_; }  ///< contact of the last step
  double step_s() const { return world_.step_s(); }
  /// Physics steps per frame of the robot's camera.
  int steps_per_frame() const { return steps_per_frame_; }
  long steps() const { return steps_; }
  double time_s() const { return static_cast<double>(steps_) * world_.step_s(); }

  // Distance since the start.
  double length_m() const { return length_m_; }
  double max_penetration_m() const { return max_penetration_m_; }
  double contact_time_s() const { return contact_time_s_; }
  double reflex_time_s() const { return reflex_time_s_; }
  const DrivePeaks& peaks() const { return meter_.peaks(); }
  const std::vector<Bump>& bumps() const { return bumps_; }

 private:
  Robot robot_;
  int steps_per_frame_;
  PlanarWorld world_;
  std::vector<MovingObstacle> others_;
  std::optional<Reflex> reflex_;
  Motors motors_;
  JerkLimiter limiter_;
  PeakMeter meter_;
  BaseState state_;
  Contact contact_;
  double reflex_m_per_s_;
  double driven_m_per_s_ = 0;  ///< speed, not counting pushes by others
  long steps_ = 0;
  double length_m_ = 0, max_penetration_m_ = 0, contact_time_s_ = 0, reflex_time_s_ = 0;
  std::vector<Bump> bumps_;
};

}  // namespace mh
