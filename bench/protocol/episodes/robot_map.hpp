// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "robots/model/robot.hpp"
#include "robots/navigation/navigator.hpp"
#include "slam/core/sequence.hpp"
#include "slam/core/trajectory.hpp"
#include "slam/occupancy/objects.hpp"
#include "slam/occupancy/obstacle_grid.hpp"
#include "slam/occupancy/occupancy_grid.hpp"
#include "slam/occupancy/voxel_map.hpp"

namespace mh {

/// What a robot made of its mapping tour, for any SLAM system: the bench's mapper with the system's
/// own poses, and the labels that came with the frames. Map frame: the base at the first tracked
/// frame, z up; the robot knows how its camera is mounted.
struct RobotMap {
  SE3 map_from_estimate;  ///< estimate: the system's own world
  OccupancyGrid grid;
  std::vector<MapObject> objects;
  std::vector<std::vector<Eigen::Vector2d>> footprints_m;  ///< of each object: cells that it covers
  KnownMap known;                                          ///< the grid, as the navigator reads it

  bool empty() const { return known.blocked.empty(); }
};

/// Adds what a robot's lasers read at one moment.
/// @param map_from_base  assumed pose of the robot
/// @param lasers_m       by laser, as RobotReading's
void add_scans(ScanGrid& scans, const Equipment& equipment, const SE3& map_from_base,
               std::span<const std::vector<float>> lasers_m);

/// A grid as the navigator reads it, with the walls that its map saw.
KnownMap known_map(const VoxelMap& map, const OccupancyGrid& grid);

/// The cells that each object covers (their centers, m): of its class, inside its box. A box alone
/// says too much of a thing that stands askew in the map's frame.
std::vector<std::vector<Eigen::Vector2d>> footprints_of(const VoxelMap& map,
                                                        const std::vector<MapObject>& objects);

/// Frames that the map is made of: those of the trajectory after which the camera moved or turned
/// by some, as indices of the sequence.
std::vector<std::size_t> frames_for_map(const Sequence& frames, const Trajectory& estimate);

/// What a map is built from.
struct MapInput {
  const Sequence& frames;
  const Trajectory& estimate;  ///< world_from_camera in the system's own world
  const Robot& robot;
  RandomStream noise;  ///< of the frames
  /// The scans at a frame, by laser; empty: depth alone makes the grid.
  std::function<std::vector<std::vector<float>>(std::size_t frame)> lasers = {};
};

/// Builds the map from depth, labels and lasers. Makes the frames again; what was seen in a second
/// attempt after tracking failed is seen with the noise of the first.
/// An empty map if nothing was tracked, or no free floor was seen.
RobotMap build_robot_map(const MapInput& input);

/// The objects meant by a name, as goals, the best-scored first.
/// @throws InputError with suggestions if the map has none.
std::vector<NavigatorGoal> goals_named(const RobotMap& map, const std::string& name);

}  // namespace mh
