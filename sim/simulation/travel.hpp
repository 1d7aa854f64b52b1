// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "robots/model/robot.hpp"
#include "scenes/scene.hpp"
#include "sim/motion/motion.hpp"
#include "sim/sensors/config.hpp"
#include "sim/simulation/pedestrian.hpp"

namespace mh {

/// Prefixes of the names of motions that are generated for a scene.
inline constexpr std::array<const char*, 3> kMadeMotions{"auto", "survey", "handheld"};

/// Moves the camera through a scene along a named motion:
/// - a file: the tour in it (load_tour);
/// - `auto[:SEED]`: a tour through all of the floor (automatic_tour);
/// - `survey[:SEED]`: the same, looking around at every place;
/// - `handheld[:SEED[:FRAMES]]`: a handheld scan (handheld_scan), 300 to 1,500 frames depending on
///   the size of the place;
/// - `replay:FILE`: a recorded trajectory in TUM's format (replay);
/// - `commands:FILE`: a script of velocity commands (load_commands).
/// Positions of tours and heights over the floor are in the floor's frame (world_from_floor). The
/// generated ones are also accepted as suites write them, `generated:auto:SEED`.
/// @param others  moving obstacles; only a driven motion meets them
/// @throws InputError if there is no such motion, a file is bad or the path is blocked.
DrivenPath travel(const Scene& scene, const Robot& robot, const std::string& motion,
                  const std::vector<MovingObstacle>& others = {});

/// The number of frames that a motion's name specifies (`handheld:SEED:FRAMES`); nullopt: the scene
/// or a file decides. @throws InputError if there is no such motion.
std::optional<std::size_t> frames_stated(const std::string& motion);

/// Keeps the first frames of a path and their length; the other measures, which need the whole
/// drive, become NaN. @returns whether anything was cut off
bool cut(DrivenPath& path, std::size_t max_frames);

/// Returns the path of a handheld camera, traveled in less time as specified by the level's
/// `hurry`: poses at the camera's rate, interpolated where a frame falls between two of the path's.
/// A robot that drives keeps its own speed. @param motion what `path` came from
DrivenPath hurried(DrivenPath path, const std::string& motion, const SensorConfig& level,
                   double rate_hz);

/// Concatenates two paths, without motion in between: the stamps continue at the camera's rate.
DrivenPath joined(DrivenPath first, const DrivenPath& second, double rate_hz);

/// Whether the robot drives, moved by physics; otherwise only a camera is moved.
bool is_driven(const std::string& motion);

/// Note to the user on where the robot deviates from the motion's file, or what part of a recorded
/// path is left out; "" if neither applies.
std::string note_on(const std::string& motion, const Robot& robot);

/// Returns the pedestrian as an obstacle for the physics, starting from a time along the path.
MovingObstacle as_obstacle(const Scene& scene, const Pedestrian& pedestrian, double from_s = 0);

/// Checks everything about `motion` that does not need the scene. @throws InputError if it is bad.
void check_motion(const std::string& motion);

}  // namespace mh
