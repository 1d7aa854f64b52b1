// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "bench/live/errand.hpp"
#include "bench/live/live_page.hpp"
#include "scenes/recordings/messages/robot_types.hpp"
#include "scenes/recordings/ros/camera_messages.hpp"
#include "sim/motion/commands.hpp"
#include "sim/simulation/robot_messages.hpp"
#include "sim/simulation/simulation.hpp"
#include "slam/pipeline/slam.hpp"

namespace mh {

/// What the page of `modelhouse live` shows and steers: a robot in a scene and the SLAM system that
/// maps it, which are stepped together. Messages are JSON objects (docs/live.md). If the same
/// commands arrive before the same steps, the results are the same to the bit.
class LiveDrive {
 public:
  static constexpr double kStep_s = 1.0 / 15;

  /// @param scenes  states of one scene, such as furniture moved or evening; the first is mapped
  /// @throws InputError if the robot cannot drive or stand in the scene
  LiveDrive(std::vector<SimulatedScene> scenes, const Robot& robot, const SensorConfig& level,
            std::shared_ptr<const Vocabulary> vocabulary, std::uint64_t seed);

  /// The first message to a viewer: the plan, the classes, the robot. Safe to call from another
  /// thread.
  std::string greeting() const;
  /// Takes a viewer's message, which takes effect at the next step. Safe to call from another
  /// thread.
  /// @returns why the message was not understood; empty if it was understood
  std::string take(const std::string& message);

  /// What to show after a step; empty what nobody wants.
  struct Shown {
    std::string state;  ///< JSON
    PageImages images;
    std::vector<MessageLog::Entry> messages;  ///< what a ROS 2 robot would publish, by stamp
  };
  enum Wanted { kNothing = 0, kPage = 1, kMessages = 2 };
  /// Drives and maps for kStep_s of simulated time.
  /// @param wanted  any of Wanted, combined by |
  Shown step(int wanted = kPage);

  /// The topics of the messages: those of `drive` and `render`, and what SLAM made of them:
  /// `/slam/pose`, and once a second `/slam/keyframes` and `/slam/landmarks`.
  const std::vector<TopicSpec>& topics() const { return log_.topics(); }
  /// The commands since the robot was last put down, as a script that `drive` repeats
  /// (`commands:FILE`).
  const CommandScript& driven() const { return driven_; }

 private:
  struct Asked {
    Twist2d velocity;
    int steps_left = 0;  ///< at 0, the robot stops since its driver is gone
    bool kidnap = false, restart = false;
    std::optional<std::string> go;  ///< to what; empty: nowhere
    std::optional<bool> light, wheels;
    std::optional<double> gamma, xi;
    std::optional<std::size_t> scene;
  };
  void obey(const Asked& asked);
  void put_down();
  void note(const Twist2d& velocity);
  std::string state(const RobotObservation& seen, const StepReport& report) const;
  std::vector<MessageLog::Entry> messages(const RobotObservation& seen, const StepReport& report);
  void add_landmarks(const ros::Header& header);

  const SimulatedScene& scene() const { return scenes_[at_]; }

  std::vector<SimulatedScene> scenes_;
  std::size_t at_ = 0;  ///< the scene that the robot is in
  Robot robot_;
  SensorConfig level_;
  std::shared_ptr<const Vocabulary> vocabulary_;
  std::uint64_t seed_;
  Simulation simulation_;
  Twist2d velocity_ = Twist2d::Zero();  ///< commanded for the last step
  CommandScript driven_;
  MessageLog log_{ros::Wire::kCdr};
  CameraMessages camera_messages_;
  RobotMessages robot_messages_;
  struct {
    std::size_t pose, keyframes, landmarks;
  } slam_topics_;
  SlamState slam_;
  bool has_told_ = false;              ///< what messages say once
  std::optional<SE3> world_from_map_;  ///< known from the first tracked frame on
  std::uint64_t frames_ = 0, carried_ = 0;
  int dark_steps_ = 0;  ///< number of steps until the light is on again
  bool light_ = true;
  bool wheels_ = true;  ///< whether SLAM is given the odometry of the wheels
  /// The robot was carried away and is not relocalized yet: its wheels were in the air, so their
  /// odometry is useless.
  bool lifted_ = false;
  KeptViews views_;
  std::optional<Errand> errand_;
  Twist2d errand_command_ = Twist2d::Zero();
  std::string note_;  ///< for the viewers: why an errand is not done
  std::mutex mutex_;
  Asked asked_;  ///< guarded by mutex_
};

}  // namespace mh
