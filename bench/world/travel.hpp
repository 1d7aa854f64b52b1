// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "robots/model/robot.hpp"
#include "scenes/scene.hpp"
#include "sim/motion/motion.hpp"

namespace mh {

/// Moves the camera through a scene in the way that a name tells:
/// - a file: the tour in it (load_tour);
/// - `auto[:SEED]`: a tour through all of the floor (automatic_tour);
/// - `handheld[:SEED[:FRAMES]]`: a scan by hand (scan_by_hand), 300 to 1,500 frames by the size of
///   the place;
/// - `replay:FILE`: a recorded trajectory in TUM's format (replay);
/// - `commands:FILE`: a script of velocity commands (load_commands).
/// The second and third also as suites write them, `generated:auto:SEED`.
/// @throws InputError if there is no such motion, a file is bad or the way is blocked.
DrivenPath travel(const Scene& scene, const Robot& robot, const std::string& motion);

/// Whether `motion` can be read: what can be told without the scene. @throws InputError if not.
void check_motion(const std::string& motion);

}  // namespace mh
