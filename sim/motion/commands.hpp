// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/motion/motion.hpp"
#include "sim/physics/planar_world.hpp"

namespace mh {

/// Commands for a period of time: the base's velocity in its own frame, and where the head should
/// look.
struct VelocityCommand {
  double duration_s = 0;
  double forward_m_per_s = 0, left_m_per_s = 0, turn_rad_per_s = 0;
  // nullopt: unchanged; initially 0.
  std::optional<double> head_yaw_rad = {}, head_pitch_rad = {};
  int line = 0;  ///< in the script's file, for messages; 0 = none
};

/// A script of velocity commands for a robot.
struct CommandScript {
  std::string name;
  std::filesystem::path file;  ///< its source, for messages
  Eigen::Vector2d start_m = Eigen::Vector2d::Zero();
  double start_heading_rad = 0;
  int start_line = 0;  ///< in the file, for messages; 0 = none
  /// Whether the external-collision reflex is active; nullopt: if the robot has one.
  std::optional<bool> reflex = {};
  std::vector<VelocityCommand> commands;
};

/// Reads a script (YAML): `name`; `start: {position: [x, y], heading_deg}`; optional `reflex`;
/// `commands`, a list of mappings with `for_s` and any of `forward_m_per_s`, `left_m_per_s`,
/// `turn_deg_per_s`, `head_yaw_deg`, `head_pitch_deg`.
/// @throws InputError naming file, line, field and value.
CommandScript load_commands(const std::filesystem::path& file);

/// The script as a file that load_commands() reads. Angles are in degrees there, so they may differ
/// in their last bits.
std::string commands_text(const CommandScript& script);

struct CommandedDrive {
  DrivenPath path;
  double reflex_time_s = 0;  ///< time that the reflex kept the robot below the commanded speed
};

/// Drives the robot as scripted, with physics: velocity, acceleration, jerk and wheel rim speed
/// stay within its limits, the head's joints within theirs. Unlike a tour, a script has no
/// destination: if something is in the way, the robot stops before it (reflex) or against it.
/// @param others  moving obstacles
/// @throws InputError, naming file and line, if the start is inside something, a head angle is out
/// of the joint's range, or the script needs something that the robot lacks: a head, a reflex, or
/// sideways motion (a differential base has none).
CommandedDrive drive(const Scene& scene, const Robot& robot, const CommandScript& script,
                     const std::vector<MovingObstacle>& others = {});

}  // namespace mh
