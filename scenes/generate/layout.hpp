// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenes/furniture/furniture.hpp"
#include "scenes/house/plan.hpp"
#include "slam/core/grid2d.hpp"

namespace mh {

/// Corners of an upright box's footprint, counter-clockwise, m.
using Footprint = std::array<Eigen::Vector2d, 4>;

Footprint footprint_of(const Eigen::Vector2d& middle_m, double turn_deg, double width_m,
                       double depth_m);
/// Transforms a point to the room's frame from the frame of something that is at `middle_m` and
/// rotated by `turn_deg`.
Eigen::Vector2d from_frame(const Eigen::Vector2d& middle_m, double turn_deg,
                           const Eigen::Vector2d& local_m);

/// A stretch of wall and the space in front of it.
struct WallRun {
  Side side = Side::kSouth;  ///< where the wall is, seen from the floor in front of it
  double face_m = 0, from_m = 0, to_m = 0;
  bool outer = true;  ///< may have a window

  /// The center of something of this depth whose back is `gap_m` in front of the wall.
  Eigen::Vector2d place(double along_m, double depth_m, double gap_m) const;
  double turn_deg() const;  ///< of a piece with its back to the wall
};

struct WallOpening {
  std::string name;
  Side side = Side::kSouth;
  double from_m = 0, to_m = 0, low_m = 0, high_m = 0;
  bool door = false;
};

struct LayoutItem {
  std::string name;
  const FurnitureKind* kind = nullptr;
  Eigen::Vector2d at_m = Eigen::Vector2d::Zero();  ///< world
  double z_m = 0, turn_deg = 0;
  Eigen::Vector3d size_m = Eigen::Vector3d::Ones();
  std::optional<std::size_t> on;                      ///< the piece that carries it
  Eigen::Vector2d on_at_m = Eigen::Vector2d::Zero();  ///< in the carrier's frame
  double on_turn_deg = 0;
  bool on_board = false;                         ///< inside the carrier, not on its top
  std::optional<std::size_t> under;              ///< the piece that it is pushed under
  bool covers_window = false;                    ///< blinds
  bool fitting = false;                          ///< not counted as an object
  std::map<std::string, std::string> materials;  ///< role -> name of a material
  std::optional<Eigen::Vector3d> glow;

  Footprint footprint() const { return footprint_of(at_m, turn_deg, size_m.x(), size_m.y()); }
};

/// A room being furnished: tracks what is where, and keeps the floor passable.
class Layout {
 public:
  static constexpr double kRobotRadius_m = 0.26;  ///< half of 0.52 m
  static constexpr double kPlay_m = 0.03;         ///< clearance on each side of the robot's paths
  static constexpr double kCell_m = 0.02;

  /// @param cut  the missing corner of an L-shaped room
  Layout(double width_m, double depth_m, double height_m, std::optional<FloorRect> cut);

  const FloorRect& rect() const { return rect_; }
  const std::optional<FloorRect>& cut() const { return cut_; }
  double height_m() const { return height_m_; }
  double floor_area_m2() const;
  const std::vector<WallRun>& walls() const { return walls_; }
  const std::vector<WallOpening>& openings() const { return openings_; }
  const std::vector<LayoutItem>& items() const { return items_; }
  const LayoutItem& item(std::size_t i) const { return items_[i]; }

  /// Marks a wall that has other rooms behind it: it gets no windows.
  void close(Side side) { walls_[static_cast<std::size_t>(side)].outer = false; }
  /// Adds an opening if it fits into a stretch of wall, clear of the other openings. @returns
  /// whether it fits
  bool add_opening(const WallRun& wall, WallOpening opening);
  /// Adds a piece if it is inside the room, overlaps nothing, and leaves doors, windows, its own
  /// front and the fronts of other pieces clear. All floor on which the robot fits must stay
  /// connected, even for a robot that is wider by the clearance. @returns its index, nullopt if it
  /// does not fit
  std::optional<std::size_t> add(const LayoutItem& item, double front_m);
  /// Share of the floor's area where the robot's center can be, with its clearance kept.
  double free_share() const;
  /// Number of objects: pieces, doors and windows, without fittings.
  int object_count() const;

 private:
  bool inside(const Footprint& footprint) const;
  /// Whether two boxes may intersect: those of a piece and its carrier, or of a chair and the table
  /// it is pushed under.
  bool belong_together(const LayoutItem& item, std::size_t i) const;
  bool apart(const LayoutItem& item) const;
  bool leaves_openings(const LayoutItem& item) const;
  bool in_the_way(const LayoutItem& item) const;  ///< whether it is in the robot's way
  void narrow(Grid2d<float>& room, const Footprint& footprint) const;
  bool connected(const Grid2d<float>& room, double radius_m) const;
  Eigen::Vector2d cell_center(int x, int y) const;

  FloorRect rect_;
  double height_m_;
  std::optional<FloorRect> cut_;
  std::vector<WallRun> walls_;
  std::vector<WallOpening> openings_;
  std::vector<LayoutItem> items_;
  std::vector<Footprint> swings_;  ///< of doors
  std::vector<Footprint> fronts_;  ///< floor in front of pieces, where only their own chairs may be
  Grid2d<float> room_m_;  ///< distance from a cell's center to the nearest obstacle, m; exact only
                          ///< where it matters
};

}  // namespace mh
