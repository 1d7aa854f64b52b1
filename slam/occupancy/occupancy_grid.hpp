// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "slam/core/grid2d.hpp"

namespace mh {

// Values of an OccupancyGrid's cells, as in ROS nav_msgs/OccupancyGrid.
inline constexpr std::int8_t kFreeCell = 0;
inline constexpr std::int8_t kOccupiedCell = 100;
inline constexpr std::int8_t kUnknownCell = -1;

/// The floor seen from above. Cell (x, y) covers [x, x+1) x [y, y+1) times resolution_m from
/// origin_m, along axes turned by yaw_rad; so, without yaw, row 0 is the southernmost and y grows
/// north (images are flipped on writing).
struct OccupancyGrid {
  Grid2d<std::int8_t> cells;
  double resolution_m = 0.05;
  /// World position of the corner of cell (0, 0).
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();
  double yaw_rad = 0;  ///< world_from_grid, counterclockwise about that corner

  /// World position of the center of a cell.
  Eigen::Vector2d center_m(int x, int y) const {
    return origin_m +
           Eigen::Rotation2Dd(yaw_rad) * (resolution_m * Eigen::Vector2d(x + 0.5, y + 0.5));
  }
  /// The cell that contains a place; nullopt outside.
  std::optional<Eigen::Vector2i> cell_of(const Eigen::Vector2d& place_m) const;
};

/// How map_server reads the gray levels of a PGM. Both are documented by nav2_map_server.
enum class GridMode {
  kTrinary,  ///< 254 free, 0 occupied, 205 unknown; thresholds on (255 - gray) / 255
  kRaw,      ///< a gray level is the cell's value; 255 is unknown
};

/// Writes stem.pgm and stem.yaml as ROS map_server and nav2_map_server read them (upper row =
/// north). @throws InputError if a file cannot be written.
void save_map_server(const OccupancyGrid& grid, const std::filesystem::path& stem,
                     GridMode mode = GridMode::kTrinary);

/// Gray levels of an image, upper row first, and which pixels are not fully opaque.
struct GrayImage {
  Grid2d<std::uint8_t> levels;
  std::vector<bool> clear;  ///< empty: all are opaque
};
/// Decodes the bytes of an image that is not a PGM. @throws InputError stating what is wrong with
/// it
using ImageDecoder = std::function<GrayImage(const std::string& bytes)>;

/// Reads a map from its YAML file as nav2_map_server does: in mode trinary, scale or raw, rotated
/// or not. Pixels that are not opaque are unknown, except in mode raw.
/// @param decode for images other than PGM; null: they are refused
/// @param warnings  receives what was ignored: keys that map_server does not define, bytes after
/// the image, values out of range; may be null
/// @throws InputError naming file, line, field and value.
OccupancyGrid load_map_server(const std::filesystem::path& yaml_file,
                              std::vector<std::string>* warnings = nullptr,
                              const ImageDecoder& decode = nullptr);

}  // namespace mh
