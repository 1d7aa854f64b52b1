// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/run/maps/laser_scans.hpp"
#include "bench/run/maps/map_score.hpp"
#include "slam/core/trajectory.hpp"
#include "slam/occupancy/floor_frame.hpp"
#include "slam/occupancy/objects.hpp"
#include "slam/occupancy/obstacle_grid.hpp"
#include "slam/occupancy/occupancy_mapper.hpp"

namespace mh {

/// What is derived from a voxel map.
struct MapStudy {
  OccupancyGrid grid;
  std::vector<MapObject> objects;
};
/// @param scans  a second source for the grid; may be null
MapStudy study_of(const VoxelMap& map, const ObstacleGridConfig& config,
                  const ScanGrid* scans = nullptr);

/// Files that write_map_files() and `map build` write.
inline constexpr std::array<const char*, 12> kMapFiles{"map.ot",
                                                       "map.bt",
                                                       "grid.pgm",
                                                       "grid.yaml",
                                                       "grid_raw.pgm",
                                                       "grid_raw.yaml",
                                                       "cost.pgm",
                                                       "cost.yaml",
                                                       "objects.json",
                                                       "grid_classes.png",
                                                       "grid_against_truth.png",
                                                       "score.json"};

/// Writes only the octree. @throws InputError naming the file.
void write_octree(const std::filesystem::path& folder, const VoxelMap& map);
/// Writes the octree, the grid (trinary and raw), costs and objects. @throws InputError naming the
/// file.
void write_map_files(const std::filesystem::path& folder, const VoxelMap& map,
                     const MapStudy& study);

/// The pose at a stamp; nullptr if there is none.
const TimedPose* pose_at(const Trajectory& trajectory, Stamp stamp_ns);

/// Finds the floor in the depth of kept keyframes at these poses.
std::optional<FloorFrame> floor_of(const OccupancyMapper& mapper,
                                   const Trajectory& world_from_camera);

/// The scores of a map against the exact mesh, and those of a map made from the same frames at
/// their true poses.
struct MapScores {
  std::size_t keyframes = 0;
  VoxelScore voxels, voxels_true_poses;
  GridScore grid, grid_true_poses;
  ObjectScore objects, objects_true_poses;
  OccupancyGrid plan;  ///< the true floor plan
};

struct MapScoreConfig {
  double resolution_m = 0.05;
  double floor_z_m = 0;
  double robot_height_m = 1.21;
};

/// @param mapper  holds the map of `study` and the depth of its keyframes; in the scene's frame
/// @param truth   true poses of the keyframes; keyframes without one are left out
/// @param lasers  the lasers whose scans are in the study's grid; may be null
MapScores score_map(const Scene& scene, const OccupancyMapper& mapper, const Trajectory& truth,
                    const MapStudy& study, const MapScoreConfig& config,
                    const SceneLasers* lasers = nullptr);

std::string scores_json(const MapScores& scores);
std::string scores_text(const MapScores& scores);

}  // namespace mh
