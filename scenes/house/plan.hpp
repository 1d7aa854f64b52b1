// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "scenes/furniture/furniture.hpp"
#include "scenes/materials/materials.hpp"

namespace mh {

/// An axis-aligned rectangle on the floor, m.
struct FloorRect {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool contains(const Eigen::Vector2d& p, double tolerance_m = 0.0) const {
    return p.x() >= x0 - tolerance_m && p.x() <= x1 + tolerance_m && p.y() >= y0 - tolerance_m &&
           p.y() <= y1 + tolerance_m;
  }
};

/// Walls of a room, by the side on which they stand (north = +y, east = +x).
enum class Side { kSouth, kNorth, kWest, kEast };
inline constexpr std::array kSides = {Side::kSouth, Side::kNorth, Side::kWest, Side::kEast};
std::string_view side_name(Side side);
/// Whether a wall on that side runs along x.
constexpr bool runs_along_x(Side side) {
  return side == Side::kSouth || side == Side::kNorth;
}
/// 1 if the direction from that wall into the room is along +x or +y, -1 otherwise.
constexpr double inward(Side side) {
  return side == Side::kSouth || side == Side::kWest ? 1.0 : -1.0;
}
/// Rotation of a piece with its back to that wall, so that its front (-y) faces the room.
constexpr double turn_before_wall_deg(Side side) {
  constexpr std::array kTurn = {180.0, 0.0, 90.0, -90.0};
  return kTurn[static_cast<std::size_t>(side)];
}
constexpr Side opposite(Side side) {
  constexpr std::array kOpposite = {Side::kNorth, Side::kSouth, Side::kEast, Side::kWest};
  return kOpposite[static_cast<std::size_t>(side)];
}

/// Position of the inner face of the wall on a side of a room, m: its x or its y.
double wall_at(const FloorRect& rect, Side side);
/// Start and end of that wall, m.
std::pair<double, double> wall_span(const FloorRect& rect, Side side);

struct RoomPlan {
  std::string name;
  FloorRect rect;
  MaterialSpec floor, ceiling;
  std::array<MaterialSpec, 4> walls;  ///< indexed by Side
  std::optional<FloorRect> cut;       ///< the missing corner of an L-shaped room

  /// The floor's outline, counter-clockwise, m.
  std::vector<Eigen::Vector2d> outline_m() const;
};
/// Start and end of a room's wall, without the part that a missing corner removes.
std::pair<double, double> wall_span(const RoomPlan& room, Side side);

/// A hole in a wall: a doorway or a window.
struct OpeningPlan {
  std::string name;
  std::size_t room = 0;              ///< on `side` of this room
  std::optional<std::size_t> other;  ///< doorways between rooms: the room beyond
  Side side = Side::kSouth;
  double from_m = 0, to_m = 0;   ///< along the wall, world coordinate
  double low_m = 0, high_m = 0;  ///< above the floor
  int panes = 1;                 ///< windows
  bool closed = false;           ///< doorways: with a closed door
};

struct ItemPlan {
  std::string name;  ///< "room/item"
  std::size_t room = 0;
  const FurnitureKind* kind = nullptr;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< middle of the footprint, bottom
  double turn_rad = 0;
  Eigen::Vector3d size_m = Eigen::Vector3d::Ones();
  std::optional<std::size_t> on;                  ///< index of the piece that carries it
  std::optional<std::size_t> under;               ///< index of the piece that it is pushed under
  std::map<std::string, MaterialSpec> materials;  ///< by role
  std::optional<Eigen::Vector3f> glow;            ///< lamps: linear RGB intensity at 1 m

  /// Corners of the footprint, counter-clockwise.
  std::array<Eigen::Vector2d, 4> footprint() const;
};

struct GardenPlan {
  MaterialSpec material;
  double distance_m = 10.0, height_m = 5.0, glow = 1.0;
};

struct HousePlan {
  std::string name;
  FloorRect extent;
  double height_m = 2.5, wall_m = 0.1;
  double detail = 1.0;  ///< see MeshBuilder::detail
  std::vector<RoomPlan> rooms;
  std::vector<OpeningPlan> doorways, windows;
  std::vector<ItemPlan> items;  ///< carriers come before the pieces on them
  MaterialSpec trim, window_frame;
  std::optional<GardenPlan> garden;
  std::optional<Light> sun, sky;
};

/// Overlap (m) of two convex counter-clockwise quadrilaterals; 0 or less if they do not overlap.
double overlap_m(const std::array<Eigen::Vector2d, 4>& a, const std::array<Eigen::Vector2d, 4>& b);

}  // namespace mh
