// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "sim/world/simulation.hpp"
#include "slam/pipeline/slam.hpp"

namespace mh {

/// What the page of `modelhouse live` shows and steers: a robot in a scene and the SLAM system that
/// maps it, stepped together. Messages are JSON objects (docs/live.md). The same commands before
/// the same steps give the same bits.
class LiveDrive {
 public:
  static constexpr double kStep_s = 1.0 / 15;

  /// @throws InputError if the robot cannot drive or stand in the scene
  LiveDrive(SimulatedScene scene, const Robot& robot, const SensorConfig& level,
            std::shared_ptr<const Vocabulary> vocabulary, std::uint64_t seed);

  /// The first message to a viewer: the plan, the classes, the robot. Safe to call from another
  /// thread.
  std::string greeting() const;
  /// Takes a viewer's message, which acts from the next step on. Safe to call from another thread.
  /// @returns why it was not understood; empty if it was
  std::string take(const std::string& message);

  /// What to show after a step; empty if there is no viewer.
  struct Shown {
    std::string state;                 ///< JSON
    std::string color, depth, labels;  ///< JPEG
  };
  /// Drives and maps for kStep_s of simulated time.
  Shown step(bool is_watched = true);

 private:
  struct Asked {
    Twist2d velocity;
    int steps_left = 0;  ///< at 0 the robot stops: its driver is gone
    bool kidnap = false, restart = false;
    std::optional<bool> light, wheels;
    std::optional<double> gamma, xi;
  };
  void obey(const Asked& asked);
  std::string state(const RobotObservation& seen, const StepReport& report) const;

  SimulatedScene scene_;
  Robot robot_;
  SensorConfig level_;
  std::shared_ptr<const Vocabulary> vocabulary_;
  std::uint64_t seed_;
  Simulation simulation_;
  SlamState slam_;
  std::optional<SE3> world_from_map_;  ///< known from the first tracked frame on
  std::uint64_t frames_ = 0, carried_ = 0;
  int dark_steps_ = 0;  ///< until the light is on again
  bool light_ = true;
  bool wheels_ = true;  ///< whether SLAM is given their odometry
  /// Carried away and not yet relocalized: the odometry of wheels in the air is useless.
  bool lifted_ = false;
  std::mutex mutex_;
  Asked asked_;  ///< guarded by mutex_
};

}  // namespace mh
