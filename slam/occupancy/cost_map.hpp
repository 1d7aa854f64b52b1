// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "slam/occupancy/occupancy_grid.hpp"

namespace mh {

// Costs as Nav2 numbers them (nav2_costmap_2d/cost_values.hpp).
inline constexpr std::uint8_t kFreeCost = 0;
inline constexpr std::uint8_t kInscribedCost = 253;
inline constexpr std::uint8_t kLethalCost = 254;
inline constexpr std::uint8_t kUnknownCost = 255;

struct CostMapConfig {
  double inscribed_radius_m = 0.26;  ///< of the robot's footprint; default: Pepper's disc
  double inflation_radius_m = 0.55;  ///< costs are 0 beyond this distance; Nav2's default
  double cost_scaling_factor = 3.0;  ///< 1/m, rate of the decay; the value in Nav2's bringup
};

/// A grid of costs for a planner; cells and origin as in OccupancyGrid.
struct CostMap {
  Grid2d<std::uint8_t> costs;
  double resolution_m = 0.05;
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();
  double yaw_rad = 0;
};

/// The cost at a distance from the nearest obstacle, as Nav2's inflation layer computes it: 254 at
/// 0, 253 up to the inscribed radius, then 252 exp(-factor (distance - inscribed)), truncated to an
/// integer; 0 beyond the inflation radius.
std::uint8_t cost_at_distance(double distance_m, const CostMapConfig& config);

/// Inflates the obstacles of a grid. Distances are exact, between centers of cells; the inflation
/// radius is rounded up to whole cells (Nav2's inflation_layer.cpp does so, too). As in Nav2,
/// unknown cells stay unknown except where the robot's disc would touch an obstacle (253).
/// @throws InputError naming a setting that is out of range, or a grid of resolution zero.
CostMap cost_map(const OccupancyGrid& grid, const CostMapConfig& config = {});

/// The costs as Nav2 publishes them for display, nav_msgs/OccupancyGrid: 0 free, 1 to 98 inflated,
/// 99 inscribed, 100 lethal, -1 unknown. In mode raw, nav2_map_server reads these values.
OccupancyGrid as_published(const CostMap& map);

/// Writes stem.pgm and stem.yaml: a gray level is the cost as Nav2 numbers it. (map_server reads
/// no level above 100: write as_published() for it.)
/// @throws InputError if a file cannot be written.
void save_cost_map(const CostMap& map, const std::filesystem::path& stem);
CostMap load_cost_map(const std::filesystem::path& yaml_file);

}  // namespace mh
