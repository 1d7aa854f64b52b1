// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "scenes/scene.hpp"
#include "sim/motion/motion.hpp"

namespace mh {

struct AutomaticTourConfig {
  std::uint64_t seed = 0;
  double apart_m = 1.6;     ///< between the places that are visited, about
  std::size_t places = 24;  ///< at most
};

/// A tour through all of the floor that the robot can reach (the largest connected part of it): a
/// look around at the start, a round trip through places spread over it, back to the start facing
/// as at first. Another seed begins elsewhere and visits other places.
/// @pre the scene's floor is z = 0 (LevelScene), as of all motions
/// @throws InputError if the scene has no floor, or no room on it for the robot.
Tour automatic_tour(const Scene& scene, const Robot& robot, const AutomaticTourConfig& config = {});

/// The tour with ways over the free floor in the place of straight lines: waypoints that avoid what
/// stands between two of its own are put before the latter.
/// @throws InputError naming tour, line and waypoint where one cannot be reached, and what stands
/// there.
Tour planned(const Scene& scene, const Robot& robot, const Tour& tour);

}  // namespace mh
