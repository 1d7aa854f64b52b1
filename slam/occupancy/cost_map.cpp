// SPDX-License-Identifier: Apache-2.0
#include "slam/occupancy/cost_map.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/occupancy/map_image.hpp"

namespace mh {
namespace {

void require_in(const char* name, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw InputError(fmt::format("cost map: {} = {}, not within {} to {}", name, value, low, high));
}

bool is_obstacle(const OccupancyGrid& grid, int x, int y) {
  return grid.cells.contains(x, y) && grid.cells(x, y) == kOccupiedCell;
}

}  // namespace

std::uint8_t cost_at_distance(double distance_m, const CostMapConfig& config) {
  if (distance_m == 0) return kLethalCost;
  if (distance_m <= config.inscribed_radius_m) return kInscribedCost;
  if (distance_m > config.inflation_radius_m) return kFreeCost;
  const double decay =
      std::exp(-config.cost_scaling_factor * (distance_m - config.inscribed_radius_m));
  return static_cast<std::uint8_t>((kInscribedCost - 1) * decay);
}

CostMap cost_map(const OccupancyGrid& grid, const CostMapConfig& config) {
  require_in("resolution_m", grid.resolution_m, 1e-4, 100.0);
  require_in("inscribed_radius_m", config.inscribed_radius_m, 0.0, 100.0);
  require_in("inflation_radius_m", config.inflation_radius_m, config.inscribed_radius_m, 100.0);
  require_in("cost_scaling_factor", config.cost_scaling_factor, 0.0, 1000.0);
  const int w = grid.cells.width(), h = grid.cells.height();
  CostMap map{.costs = Grid2d<std::uint8_t>(w, h, kFreeCost),
              .resolution_m = grid.resolution_m,
              .origin_m = grid.origin_m,
              .yaw_rad = grid.yaw_rad};

  struct Around {
    int x, y;
    std::uint8_t cost;
  };
  std::vector<Around> disc;
  const double radius_cells =
      std::ceil(config.inflation_radius_m / grid.resolution_m - 1e-9);  // 0.55 / 0.05 is 11
  CostMapConfig in_cells = config;
  in_cells.inflation_radius_m = grid.resolution_m * radius_cells;
  const int reach_x = static_cast<int>(std::min(radius_cells, w - 1.0)),
            reach_y = static_cast<int>(std::min(radius_cells, h - 1.0));
  for (int y = -reach_y; y <= reach_y; ++y)
    for (int x = -reach_x; x <= reach_x; ++x) {
      const double away_m = grid.resolution_m * std::sqrt(static_cast<double>(x * x + y * y));
      if (const std::uint8_t cost = cost_at_distance(away_m, in_cells); cost > kFreeCost)
        disc.push_back({x, y, cost});
    }
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      if (!is_obstacle(grid, x, y)) continue;
      map.costs(x, y) = kLethalCost;
      // A cell surrounded by obstacles is not the nearest obstacle of any free cell.
      if (is_obstacle(grid, x - 1, y) && is_obstacle(grid, x + 1, y) &&
          is_obstacle(grid, x, y - 1) && is_obstacle(grid, x, y + 1))
        continue;
      for (const Around& a : disc)
        if (map.costs.contains(x + a.x, y + a.y)) {
          std::uint8_t& cost = map.costs(x + a.x, y + a.y);
          cost = std::max(cost, a.cost);
        }
    }
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      if (grid.cells(x, y) == kUnknownCell && map.costs(x, y) < kInscribedCost)
        map.costs(x, y) = kUnknownCost;
  return map;
}

OccupancyGrid as_published(const CostMap& map) {
  OccupancyGrid grid{.cells = Grid2d<std::int8_t>(map.costs.width(), map.costs.height()),
                     .resolution_m = map.resolution_m,
                     .origin_m = map.origin_m,
                     .yaw_rad = map.yaw_rad};
  std::transform(map.costs.begin(), map.costs.end(), grid.cells.begin(), [](std::uint8_t cost) {
    if (cost == kUnknownCost) return kUnknownCell;
    if (cost == kLethalCost) return kOccupiedCell;
    if (cost == kInscribedCost) return std::int8_t{99};
    return static_cast<std::int8_t>(cost == 0 ? 0 : 1 + 97 * (cost - 1) / 251);
  });
  return grid;
}

void save_cost_map(const CostMap& map, const std::filesystem::path& stem) {
  write_map_image({map.costs, map.resolution_m, map.origin_m, map.yaw_rad, {}}, stem, "raw");
}

CostMap load_cost_map(const std::filesystem::path& yaml_file) {
  YamlReader yaml = YamlReader::load(yaml_file);
  if (const std::string mode = yaml.string("mode", "trinary"); mode != "raw")
    yaml.at("mode").fail("'" + mode + "' holds no costs, only raw does");
  MapImage image = read_map_image(yaml, yaml_file);
  yaml.integer("negate", 0, 0);
  yaml.number("occupied_thresh", 0, 1);
  yaml.number("free_thresh", 0, 1);
  yaml.finish();
  return {.costs = std::move(image.levels),
          .resolution_m = image.resolution_m,
          .origin_m = image.origin_m,
          .yaw_rad = image.yaw_rad};
}

}  // namespace mh
