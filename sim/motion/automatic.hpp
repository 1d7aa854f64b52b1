// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "scenes/scene.hpp"
#include "sim/motion/motion.hpp"

namespace mh {

struct AutomaticTourConfig {
  std::uint64_t seed = 0;
  double apart_m = 1.6;     ///< approximate distance between visited places
  std::size_t places = 24;  ///< maximum number of visited places
  bool survey = false;      ///< looks around at every place, not only at the start
};

/// Makes a tour through the whole floor that the robot can reach (its largest connected part): a
/// look around at the start, a round trip through places spread over it, and back to the start with
/// the initial heading. A survey, meant for mapping, looks around at each of the places and drives
/// at most at 0.35 m/s and 0.6 rad/s. A different seed starts elsewhere and visits different
/// places.
/// @pre the scene's floor is z = 0 (LevelScene), as for all motions
/// @throws InputError if the scene has no floor, or no space on it for the robot.
Tour automatic_tour(const Scene& scene, const Robot& robot, const AutomaticTourConfig& config = {});

/// Returns the tour with paths over the free floor instead of straight lines: waypoints that avoid
/// obstacles are inserted between its own.
/// @throws InputError naming the tour, the line, the waypoint that cannot be reached and what
/// blocks it.
Tour planned(const Scene& scene, const Robot& robot, const Tour& tour);

}  // namespace mh
