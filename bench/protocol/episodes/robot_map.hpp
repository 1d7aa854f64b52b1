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

/// The map that a robot makes from its mapping tour, with any SLAM system: the bench's mapper
/// integrates the frames, with their labels, at the system's own poses. Map frame: the base at the
/// first tracked frame, z up; the robot knows how its camera is mounted.
struct RobotMap {
  SE3 map_from_estimate;  ///< estimate: the system's own world
  OccupancyGrid grid;
  std::vector<MapObject> objects;
  std::vector<std::vector<Eigen::Vector2d>> footprints_m;  ///< cells that each object covers
  KnownMap known;                                          ///< the grid, as the navigator reads it

  bool empty() const { return known.blocked.empty(); }
};

/// Adds what a robot's lasers read at one time.
/// @param map_from_base  assumed pose of the robot
/// @param lasers_m       the ranges of each laser, as in RobotReading
void add_scans(ScanGrid& scans, const Equipment& equipment, const SE3& map_from_base,
               std::span<const std::vector<float>> lasers_m);

/// Converts a grid to the form that the navigator reads, with the walls seen in the voxel map.
KnownMap known_map(const VoxelMap& map, const OccupancyGrid& grid);

/// The cells that each object covers (their centers, m): those of its class inside its box. The box
/// alone is too large for a thing that is not aligned with the map's axes.
std::vector<std::vector<Eigen::Vector2d>> footprints_of(const VoxelMap& map,
                                                        const std::vector<MapObject>& objects);

/// A view adds something new to the map once the camera has moved or turned this much: when it
/// turns by 0.26 rad, a point 2 m away shifts by half a meter.
inline constexpr double kViewMoved_m = 0.25, kViewTurned_rad = 0.26;

/// Indices of the frames that the map is made from: they have a pose, and the camera has moved or
/// turned enough since the previous one of them.
std::vector<std::size_t> frames_for_map(const Sequence& frames, const Trajectory& estimate);

/// What a map is built from.
struct MapInput {
  const Sequence& frames;
  const Trajectory& estimate;  ///< world_from_camera in the system's own world
  const Robot& robot;
  RandomStream noise;  ///< of the frames
  /// Returns the scans at a frame, one for each laser; if this is empty, the grid is made from
  /// depth alone.
  std::function<std::vector<std::vector<float>>(std::size_t frame)> lasers = {};
};

/// Builds the map from depth, labels and lasers. Renders the frames again; a frame that was shown
/// several times because tracking failed gets the noise of its first showing. The map is empty if
/// nothing was tracked or no free floor was seen.
RobotMap build_robot_map(const MapInput& input);

/// The objects that a name refers to, as goals, the one with the best score first.
/// @throws InputError with suggestions if the map has no such object.
std::vector<NavigatorGoal> goals_named(const RobotMap& map, const std::string& name);

}  // namespace mh
