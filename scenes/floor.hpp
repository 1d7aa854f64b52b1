// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "scenes/scene.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// Whether a class is walkable: floors, and things that lie flat on them.
bool is_walked_on(ClassId class_id);

/// Faces of a walkable class are part of the floor up to this height above it, and down to
/// kDeepestFloor_m below: scanned floors sag and are rough.
inline constexpr double kHighestFloor_m = 0.15, kDeepestFloor_m = 0.3;

/// A floor, the bounding box of its faces as a room, and the extent of the things on it.
struct FoundFloor {
  Floor floor;
  Room room;
  Eigen::AlignedBox2d things_m;  ///< empty: unknown
};

/// Clips rooms that are boxes to 2 m around the things in the scene: a ground plane may extend to
/// the horizon, but robots and cameras stay near the objects.
void end_rooms_near_things(std::vector<Room>& rooms, const Eigen::AlignedBox2d& things_m);

/// Finds the floor of a scene that does not state one: from the faces of a walkable class or, if
/// there are too few, from the lowest large level surface with headroom to stand. If there are two
/// levels, the lower one is taken if it is at least a quarter as large as the larger. A plane is
/// fitted that may slope by up to 2 degrees; steeper fits are replaced by a level plane.
/// Floor::rough_m is set to five standard deviations of the floor's height, but to at least 0.03
/// and at most 0.12 m.
/// @param floor_z_m  the floor's height as stated by the user: the floor is then a level plane
/// @param warnings   where to append anything doubtful; may be null
/// @returns nullopt if there is nothing to stand on.
std::optional<FoundFloor> find_floor(const Scene& scene, std::optional<double> floor_z_m = {},
                                     std::vector<std::string>* warnings = nullptr);

/// Whether a scene looks as if its file had y up: its labeled floor is vertical or, if no floor is
/// labeled, the scene is shaped like a room that lies on its side.
bool looks_y_up(const Scene& scene);

/// Turns a scene from y up to z up, as for glTF: (x, y, z) becomes (x, -z, y). `back` reverses it.
void turn_y_up(Scene& scene, bool back = false);

/// The floor's own frame: z = 0 is the floor, x and y are nearly the world's (a slope of 2 degrees
/// shifts them by 0.6 mm per meter).
SE3 world_from_floor(const Floor& floor);

/// A scene in the frame of its floor: the scene itself if its floor is z = 0, otherwise a copy of
/// its geometry (without appearance) in the floor's frame.
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
