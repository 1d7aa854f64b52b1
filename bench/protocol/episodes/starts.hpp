// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/protocol/episodes/walls.hpp"
#include "bench/suite/episodes_spec.hpp"
#include "robots/model/robot.hpp"
#include "robots/navigation/grid.hpp"
#include "scenes/scene.hpp"
#include "slam/core/random.hpp"

namespace mh {

/// A thing's true bounding box, seen from above.
using TrueBox = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

/// Where the robot is put, and what it must find from there. The same for every system.
struct EpisodeStart {
  std::size_t index = 0;
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();  ///< world
  double heading_rad = 0;
  std::string goal = {};
  std::vector<TrueBox> boxes = {};  ///< of all things of the goal's class
  std::shared_ptr<const TrueWalls> walls = {};
  double shortest_m = 0;  ///< length of the shortest path over the true floor that ends in success
};

/// Distance (m) of a place from the nearest box; infinite if there is none.
double distance_to(const std::vector<TrueBox>& boxes, const Eigen::Vector2d& place_m);

/// Whether a place is within arrival_m of a box with no wall in between: a robot behind a wall has
/// not arrived.
bool is_arrival(const EpisodeStart& start, const Eigen::Vector2d& place_m, double arrival_m);

struct StandingPlace {
  Eigen::Vector2d place_m;
  double heading_rad;
};
/// Draws a place anywhere on the reachable part of the true floor, with a random heading.
/// @throws InputError if there is no floor.
StandingPlace draw_place(const Scene& scene, const Robot& robot, RandomStream draw);

/// Draws starts: anywhere on the reachable part of the true floor, with a random heading; the goal
/// is one of the spec's goals that exists in the scene and can be reached. Start i depends only on
/// i, not on the number of starts. The shortest path keeps 1.5 cm from everything and runs over 4
/// cm cells and their diagonals: it is at most 8 % longer than the true shortest path.
/// @throws InputError if there is no floor, or if no goal exists and can be reached.
std::vector<EpisodeStart> draw_starts(const EpisodesSpec& spec, const Scene& scene,
                                      const Robot& robot);

}  // namespace mh
