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

/// A thing's true box seen from above.
using TrueBox = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

/// Where the robot is put, and what it is to find there. The same for every system.
struct EpisodeStart {
  std::size_t index = 0;
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();  ///< world
  double heading_rad = 0;
  std::string goal = {};
  std::vector<TrueBox> boxes = {};  ///< of every thing of that class
  std::shared_ptr<const TrueWalls> walls = {};
  double shortest_m = 0;  ///< of the ways over the true floor that end in success
};

/// Distance (m) of a place from the nearest box; infinite if there is none.
double distance_to(const std::vector<TrueBox>& boxes, const Eigen::Vector2d& place_m);

/// Whether a place is that near to a box, with no wall between: who stands behind a wall has not
/// arrived.
bool is_arrival(const EpisodeStart& start, const Eigen::Vector2d& place_m, double arrival_m);

struct StandingPlace {
  Eigen::Vector2d place_m;
  double heading_rad;
};
/// Anywhere on the true floor that the robot can reach, turned anyhow.
/// @throws InputError if no floor is there.
StandingPlace draw_place(const Scene& scene, const Robot& robot, RandomStream draw);

/// Draws starts: anywhere on the true floor that the robot can reach, turned anyhow; the goal is
/// one of the spec's that the scene has and that can be reached. Start i depends on i alone, not on
/// how many there are. The shortest way keeps 1.5 cm from everything, over cells of 4 cm and their
/// diagonals: at most 8 % longer than the shortest of all.
/// @throws InputError if no floor or none of the goals is there.
std::vector<EpisodeStart> draw_starts(const EpisodesSpec& spec, const Scene& scene,
                                      const Robot& robot);

}  // namespace mh
