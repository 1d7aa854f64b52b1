// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <string>

#include <Eigen/Core>

#include "slam/core/camera.hpp"
#include "slam/core/grid2d.hpp"
#include "slam/core/se3.hpp"

namespace mh {

// Values of an OccupancyGrid's cells, as in ROS nav_msgs/OccupancyGrid.
inline constexpr std::int8_t kFreeCell = 0;
inline constexpr std::int8_t kOccupiedCell = 100;
inline constexpr std::int8_t kUnknownCell = -1;

/// The floor seen from above. Cell (x, y) covers [x, x+1) x [y, y+1) times resolution_m from
/// origin_m; so row 0 is the southernmost and y grows north (images are flipped on writing).
struct OccupancyGrid {
  Grid2d<std::int8_t> cells;
  double resolution_m = 0.05;
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();  ///< world position of the corner of cell (0,
                                                       ///< 0)

  /// World position of the center of a cell.
  Eigen::Vector2d center_m(int x, int y) const {
    return origin_m + resolution_m * Eigen::Vector2d(x + 0.5, y + 0.5);
  }
};

struct OccupancyConfig {
  double resolution_m = 0.05;
  double max_range_m = 4.0;  ///< longer returns only clear the space up to this range; <= 250
                             ///< resolutions
  int stride_px = 2;         ///< every n-th pixel of every n-th row is used
};

/// An octree of occupancy probabilities, built from depth images (OctoMap: Hornung et al.,
/// Autonomous Robots 2013).
class OccupancyMapper {
 public:
  explicit OccupancyMapper(const OccupancyConfig& config = {});
  ~OccupancyMapper();
  OccupancyMapper(OccupancyMapper&&) noexcept;
  OccupancyMapper& operator=(OccupancyMapper&&) noexcept;

  /// Integrates a depth image: the space up to each return is free, the return itself occupied.
  /// Each voxel is updated once per image. @param depth_m along z, undistorted, 0 = no return.
  void insert(const Grid2d<float>& depth_m, const Camera& camera, const SE3& world_from_camera);

  /// Projects the mapped volume to cells: occupied if any voxel between the heights is, else free
  /// if any of these is free, else unknown. Empty if nothing was seen between the heights.
  OccupancyGrid project(double min_z_m, double max_z_m) const;

  std::size_t leaf_count() const;

  /// Writes OctoMap's binary format (each voxel free, occupied or unknown).
  /// @throws InputError if the file cannot be written.
  void save_bt(const std::filesystem::path& file) const;
  /// Reads such a file. @throws InputError naming it.
  static OccupancyMapper load_bt(const std::filesystem::path& file);

  /// The same format to and from a stream; `name` names the file in messages.
  void write_bt(std::ostream& out) const;
  static OccupancyMapper read_bt(std::istream& in, const std::string& name);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Writes stem.pgm and stem.yaml as ROS map_server reads them (mode trinary; upper row = north).
/// @throws InputError if a file cannot be written.
void save_map_server(const OccupancyGrid& grid, const std::filesystem::path& stem);

/// Reads such a pair by its YAML file (mode trinary, no rotation).
/// @throws InputError naming file, line, field and value.
OccupancyGrid load_map_server(const std::filesystem::path& yaml_file);

}  // namespace mh
