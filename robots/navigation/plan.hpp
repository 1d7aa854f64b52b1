// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "robots/navigation/floor_grid.hpp"

namespace mh {

/// Corners of a way over the floor from one place to another that keeps the distance from
/// everything, both ends included; nothing if there is none. A way through the open is worth a
/// detour: keeping less than twice the distance costs up to three times the length. A* over the
/// grid's cells (Hart, Nilsson and Raphael, 1968), then corners that a straight line can do without
/// are left out.
/// @param clearance_m  of the robot's middle: its radius and what it strays by
std::optional<std::vector<Eigen::Vector2d>> plan_way(const FloorGrid& grid,
                                                     const Eigen::Vector2d& from_m,
                                                     const Eigen::Vector2d& to_m,
                                                     double clearance_m);

/// Length (m) of the shortest way over the grid from a place to every cell, infinite where there is
/// none.
Grid2d<float> way_lengths(const FloorGrid& grid, const Eigen::Vector2d& from_m, double clearance_m);

/// Places spread over a region, each as far as it can be from those before it, seeded.
/// @param apart_m  none is nearer than this to another
/// @param most     at most so many
std::vector<Eigen::Vector2d> spread_places(const FloorGrid& grid,
                                           const Grid2d<std::uint8_t>& region, double apart_m,
                                           std::size_t most, std::uint64_t seed);

/// Length (m) of the shortest way from each place to each other, infinite where there is none.
std::vector<std::vector<double>> lengths_between(const FloorGrid& grid,
                                                 std::span<const Eigen::Vector2d> places,
                                                 double clearance_m);

struct RoundTrip {
  std::vector<std::size_t> order = {};  ///< of the places; begins with the first
  double length_m = 0;                  ///< back to it
};

/// A short round trip through the first so many places: each time to the nearest one left, then
/// pairs of legs exchanged while that shortens it (2-opt, Croes 1958).
/// @param way_m  see lengths_between
RoundTrip round_trip(const std::vector<std::vector<double>>& way_m, std::size_t count);

}  // namespace mh
