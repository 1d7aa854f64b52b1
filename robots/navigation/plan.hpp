// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "robots/navigation/grid.hpp"

namespace mh {

/// Plans a path over the floor from one place to another that keeps `clearance_m` from everything.
/// Returns its corners, both ends included; nullopt if there is no such path. Open space is worth a
/// detour: where the clearance is less than twice the required one, length costs up to three times
/// as much. A* over the grid's cells (Hart, Nilsson and Raphael, 1968), then corners that a
/// straight line can replace are removed.
/// @param clearance_m  clearance of the robot's center: its radius plus its tracking error
std::optional<std::vector<Eigen::Vector2d>> plan_way(const FloorGrid& grid,
                                                     const Eigen::Vector2d& from_m,
                                                     const Eigen::Vector2d& to_m,
                                                     double clearance_m);

/// Length (m) of the shortest path over the grid from a place to every cell, infinite if there is
/// none.
Grid2d<float> way_lengths(const FloorGrid& grid, const Eigen::Vector2d& from_m, double clearance_m);
/// The same lengths from the nearest of several places.
Grid2d<float> way_lengths(const FloorGrid& grid, std::span<const Eigen::Vector2d> from_m,
                          double clearance_m);

/// Places spread over a region by a seed, each as far as possible from those before it.
/// @param apart_m  minimum distance between any two
/// @param most     maximum number of places
std::vector<Eigen::Vector2d> spread_places(const FloorGrid& grid,
                                           const Grid2d<std::uint8_t>& region, double apart_m,
                                           std::size_t most, std::uint64_t seed);

/// Length (m) of the shortest path between each pair of places, infinite if there is none.
std::vector<std::vector<double>> lengths_between(const FloorGrid& grid,
                                                 std::span<const Eigen::Vector2d> places,
                                                 double clearance_m);

struct RoundTrip {
  std::vector<std::size_t> order = {};  ///< indices of the places in order; begins with the first
  double length_m = 0;                  ///< including the return to the first
};

/// A short round trip through the first `count` places: nearest neighbor, then pairs of legs are
/// exchanged while that shortens the trip (2-opt, Croes 1958).
/// @param way_m  see lengths_between
RoundTrip round_trip(const std::vector<std::vector<double>>& way_m, std::size_t count);

}  // namespace mh
