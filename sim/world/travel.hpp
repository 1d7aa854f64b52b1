// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "robots/model/robot.hpp"
#include "scenes/scene.hpp"
#include "sim/motion/motion.hpp"
#include "sim/world/pedestrian.hpp"

namespace mh {

/// Moves the camera through a scene in the way that a name tells:
/// - a file: the tour in it (load_tour);
/// - `auto[:SEED]`: a tour through all of the floor (automatic_tour);
/// - `handheld[:SEED[:FRAMES]]`: a scan by hand (scan_by_hand), 300 to 1,500 frames by the size of
///   the place;
/// - `replay:FILE`: a recorded trajectory in TUM's format (replay);
/// - `commands:FILE`: a script of velocity commands (load_commands).
/// Places of tours and heights over the floor are told in the floor's frame (world_from_floor).
/// The second and third also as suites write them, `generated:auto:SEED`.
/// @param others  that move about; only a driven motion meets them
/// @throws InputError if there is no such motion, a file is bad or the way is blocked.
DrivenPath travel(const Scene& scene, const Robot& robot, const std::string& motion,
                  const std::vector<MovingObstacle>& others = {});

/// Keeps the first frames of a path with their length; the other measures, which need the whole
/// drive, become NaN. @returns whether anything was cut off
bool cut(DrivenPath& path, std::size_t max_frames);

/// One path after the other, without a way between them: the stamps go on at the camera's rate.
DrivenPath joined(DrivenPath first, const DrivenPath& second, double rate_hz);

/// Whether the robot drives, moved by physics; else a camera is moved without it.
bool is_driven(const std::string& motion);

/// What the robot does not do as the motion's file asks, for the user; "" if nothing.
std::string note_on(const std::string& motion, const Robot& robot);

/// The pedestrian as the physics meets him, from a time of his way on.
MovingObstacle as_obstacle(const Scene& scene, const Pedestrian& pedestrian, double from_s = 0);

/// Whether `motion` can be read: what can be told without the scene. @throws InputError if not.
void check_motion(const std::string& motion);

}  // namespace mh
