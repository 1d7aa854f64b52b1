// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "robots/navigation/grid.hpp"

namespace mh {

struct LostConfig {
  double least_m = 0.6, most_m = 3.0;  ///< length of one drive
  double clearance_m = 0.34;
};

/// What a lost robot does, the same for any SLAM system: it turns once in place, drives to another
/// place and turns again. Among the places that its sensors show to be free, it chooses the one
/// that is farthest from the nearest place where it has already looked around.
/// @param grid    what was seen around it (NearMap::grid)
/// @param looked  places where it has turned, in the same frame; the last is where it is now
/// @returns the path there; nullopt if no place is free
std::optional<std::vector<Eigen::Vector2d>> way_to_look_around(
    const FloorGrid& grid, const std::vector<Eigen::Vector2d>& looked,
    const LostConfig& config = {});

/// The same as plan_way(), except that the start may have too little clearance: the path then
/// begins with a straight line to the nearest place that has it.
std::optional<std::vector<Eigen::Vector2d>> way_out(const FloorGrid& grid,
                                                    const Eigen::Vector2d& from_m,
                                                    const Eigen::Vector2d& to_m,
                                                    double clearance_m);

/// The nearest place with that clearance, less than `reach_m` away; nullopt if there is none.
std::optional<Eigen::Vector2d> nearest_clear(const FloorGrid& grid, const Eigen::Vector2d& place_m,
                                             double clearance_m, double reach_m);

}  // namespace mh
