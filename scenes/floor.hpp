// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "scenes/scene.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// Whether a class is walked on: floors, and what lies flat on them.
bool is_walked_on(ClassId class_id);

/// Faces of a class that is walked on count as floor up to this height above it, and down to
/// kDeepestFloor_m below: scanned floors sag and are rough.
inline constexpr double kHighestFloor_m = 0.15, kDeepestFloor_m = 0.3;

/// A floor, the box around its faces as a room, and where things stand.
struct FoundFloor {
  Floor floor;
  Room room;
  Eigen::AlignedBox2d things_m;  ///< empty: nobody knows
};

/// Ends rooms that are boxes 2 m from where things stand: a ground that reaches to the horizon is
/// floor, but nobody drives, scans or takes pictures far from all that there is to see.
void end_rooms_near_things(std::vector<Room>& rooms, const Eigen::AlignedBox2d& things_m);

/// Finds the floor of a scene that came without one: from faces of a class that is walked on, else
/// the lowest large level surface with room above it to stand. Where there are two levels, the
/// lower one that is at least a quarter as large as the larger. A plane is fitted to it that may
/// slope by up to 2 degrees; steeper ones are taken as level. `rough_m` is five times its spread,
/// 0.03 to 0.12 m.
/// @param floor_z_m  where the user says it lies: a level plane there
/// @param warnings   where to append what is doubtful; may be null
/// @returns nullopt if there is nothing that one could stand on.
std::optional<FoundFloor> find_floor(const Scene& scene, std::optional<double> floor_z_m = {},
                                     std::vector<std::string>* warnings = nullptr);

/// Whether a scene looks as if its file had y up: its floor is upright, or it has a large level
/// surface at the bottom only when it is turned.
bool looks_y_up(const Scene& scene);

/// Turns a scene from y up to z up, as glTF is turned: (x, y, z) becomes (x, -z, y). `back` undoes
/// it.
void turn_y_up(Scene& scene, bool back = false);

/// The floor's own frame: z = 0 is the floor, x and y nearly the world's (a slope of 2 degrees
/// shifts them by 0.6 mm per meter).
SE3 world_from_floor(const Floor& floor);

/// A scene as it lies before those who move on its floor: the scene itself where its floor is
/// z = 0, else a copy of its geometry (without looks) in the floor's frame.
class LevelScene {
 public:
  explicit LevelScene(const Scene& scene);
  const Scene& operator*() const { return copy_ ? *copy_ : scene_; }
  const SE3& world_from_level() const { return world_from_level_; }

 private:
  const Scene& scene_;
  std::optional<Scene> copy_;
  SE3 world_from_level_;
};

}  // namespace mh
