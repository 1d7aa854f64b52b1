// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "robots/model/odometry.hpp"
#include "sim/motion/commanded_base.hpp"
#include "sim/motion/sensing.hpp"
#include "sim/sensors/labels.hpp"
#include "sim/sensors/sense.hpp"
#include "sim/sensors/shutter.hpp"
#include "sim/simulation/pedestrian.hpp"
#include "sim/simulation/simulated_sequence.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// A lit place to simulate a robot in. Everything is shared and only read: any number of
/// simulations may use it, in any threads.
struct SimulatedScene {
  std::shared_ptr<const Scene> scene;  ///< its floor is z = 0 (LevelScene)
  std::shared_ptr<const Renderer> renderer;
  std::shared_ptr<const PedestrianScene> pedestrian = nullptr;  ///< uses that renderer; or null
};

struct SimulationConfig {
  Eigen::Vector2d start_m = Eigen::Vector2d::Zero();
  double start_heading_rad = 0;
  /// A frame is delivered once in this many ticks of the camera: with 3, a 30 Hz camera delivers
  /// the 10 Hz that Pepper's driver publishes (naoqi_driver aed1b87, boot_config.json).
  int ticks_per_frame = 3;
  LabelMode labels = LabelMode::kExact;
  std::uint64_t seed = 0;  ///< seed of all noise
  bool reflex = false;     ///< the external-collision reflex is enabled
};

/// What the robot's sensors deliver after a step.
struct RobotObservation {
  Stamp stamp_ns = 0;
  /// Set if a frame was due during the step (the latest, if several were). Stamped one tick of the
  /// camera before it arrives: an exposure is over before it is read out.
  std::optional<RgbdFrame> frame;
  Grid2d<InstanceId> instances;  ///< of the frame's pixels, not for SLAM; empty without a frame
  /// Lasers, sonars and bumpers now; the IMU one tick ago.
  RobotReading reading;
  SE3 odom_from_base;    ///< wheel odometry
  SE3 odom_from_camera;  ///< the same for the camera, at the frame's stamp
};

/// A robot in a scene, stepped by its controller: physics, sensors and camera of a robot that is
/// commanded by velocity. Command scripts (sim/motion/commands.hpp) drive on the same
/// CommandedBase. Deterministic: the same commands give the same bits.
class Simulation {
 public:
  /// @param level  sensor settings
  /// @throws InputError if the robot has no wheels, or cannot stand at the start.
  Simulation(SimulatedScene scene, const Robot& robot, const SensorConfig& level,
             const SimulationConfig& config);

  /// Drives at a velocity in the base's frame and returns what is sensed at the end. A differential
  /// base does not obey the second component.
  /// @param dt_s  rounded to whole ticks of the camera, at least one
  RobotObservation step(const Twist2d& command, double dt_s);

  /// Lifts the robot to another place; its wheels do not turn. @throws InputError if it cannot
  /// stand there; it then stands where it was.
  void carry_to(const Eigen::Vector2d& place_m, double heading_rad);
  /// Exchanges the scene for another state of it, such as furniture moved or evening. The robot
  /// stands where it is, at rest; its sensors go on. @throws InputError if it cannot stand there;
  /// nothing has changed then.
  void change_scene(SimulatedScene scene);
  /// While the light is off, frames are blank.
  void switch_light(bool on) { light_ = on; }

  // The ground truth: for scoring only.
  const CommandedBase& truth() const { return *base_; }
  /// world_from_camera of the last frame that was delivered, at its stamp; nullopt if there is
  /// none.
  const std::optional<TimedPose>& truth_of_frame() const { return frame_pose_; }
  double time_s() const { return base_->time_s(); }

 private:
  void tick();
  TimedPose pose_now() const;
  /// Index in recent_ of the second-to-last tick's pose: the pose of the frame that arrives now.
  std::size_t tick_before() const { return recent_.size() < 2 ? 0 : recent_.size() - 2; }
  SensedMoment frame() const;

  SimulatedScene scene_;
  Robot robot_;
  SensorConfig level_;
  SimulationConfig config_;
  std::unique_ptr<CommandedBase> base_;
  WheelOdometer odometer_;
  SE3 odom_from_base_, odom_before_;  ///< now and one tick ago
  std::vector<TimedPose> recent_;     ///< world_from_base, one per tick, since it was last carried
  std::optional<TimedPose> frame_pose_;
  long ticks_ = 0;
  bool light_ = true;
};

}  // namespace mh
