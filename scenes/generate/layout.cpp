// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/layout.hpp"
#include "slam/core/angles.hpp"

#include <algorithm>
#include <cmath>

namespace mh {
namespace {

using Eigen::Vector2d;

constexpr double kDoorSwing_m = 0.95;    // floor that a door sweeps, and on which people enter
constexpr double kRobotHeight_m = 1.25;  // things that hang higher do not obstruct the robot
constexpr double kFlat_m = 0.03;         // height of rugs, which do not obstruct
constexpr double kApart_m = 0.004;       // gap between neighbors: rounding must not make them
                                         // overlap

Footprint rectangle(const FloorRect& r) {
  return {{{r.x0, r.y0}, {r.x1, r.y0}, {r.x1, r.y1}, {r.x0, r.y1}}};
}

double distance_m(const Vector2d& p, const Footprint& quad) {
  bool inside = true;
  double nearest = 1e30;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2d a = quad[i], edge = quad[(i + 1) % 4] - a, to = p - a;
    if (edge.x() * to.y() - edge.y() * to.x() < 0) inside = false;
    const double t = std::clamp(to.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (to - t * edge).norm());
  }
  return inside ? 0.0 : nearest;
}

}  // namespace

Vector2d from_frame(const Vector2d& middle_m, double turn_deg, const Vector2d& local_m) {
  const double c = std::cos(turn_deg * kDegree), s = std::sin(turn_deg * kDegree);
  return middle_m + Vector2d(c * local_m.x() - s * local_m.y(), s * local_m.x() + c * local_m.y());
}

Footprint footprint_of(const Vector2d& middle_m, double turn_deg, double width_m, double depth_m) {
  const double x = width_m / 2, y = depth_m / 2;
  return {from_frame(middle_m, turn_deg, {-x, -y}), from_frame(middle_m, turn_deg, {x, -y}),
          from_frame(middle_m, turn_deg, {x, y}), from_frame(middle_m, turn_deg, {-x, y})};
}

Vector2d WallRun::place(double along_m, double depth_m, double gap_m) const {
  const double across = face_m + inward(side) * (gap_m + depth_m / 2);
  return runs_along_x(side) ? Vector2d(along_m, across) : Vector2d(across, along_m);
}

double WallRun::turn_deg() const {
  return turn_before_wall_deg(side);
}

Layout::Layout(double width_m, double depth_m, double height_m, std::optional<FloorRect> cut)
    : rect_{0, 0, width_m, depth_m},
      height_m_(height_m),
      cut_(cut),
      room_m_(static_cast<int>(std::ceil(width_m / kCell_m)),
              static_cast<int>(std::ceil(depth_m / kCell_m)), 0.0F) {
  const double w = width_m, d = depth_m;
  walls_ = {{Side::kSouth, 0, 0, w},
            {Side::kNorth, d, 0, w},
            {Side::kWest, 0, 0, d},
            {Side::kEast, w, 0, d}};
  if (cut_) {
    const bool south = cut_->y0 <= 0, west = cut_->x0 <= 0;
    WallRun& along_x = walls_[south ? 0 : 1];
    WallRun& along_y = walls_[west ? 2 : 3];
    (west ? along_x.from_m : along_x.to_m) = west ? cut_->x1 : cut_->x0;
    (south ? along_y.from_m : along_y.to_m) = south ? cut_->y1 : cut_->y0;
    walls_.push_back({south ? Side::kSouth : Side::kNorth, south ? cut_->y1 : cut_->y0, cut_->x0,
                      cut_->x1, false});
    walls_.push_back(
        {west ? Side::kWest : Side::kEast, west ? cut_->x1 : cut_->x0, cut_->y0, cut_->y1, false});
  }
  for (int y = 0; y < room_m_.height(); ++y)
    for (int x = 0; x < room_m_.width(); ++x) {
      const Vector2d p = cell_center(x, y);
      room_m_(x, y) = static_cast<float>(std::min({p.x(), w - p.x(), p.y(), d - p.y()}));
    }
  if (cut_) narrow(room_m_, rectangle(*cut_));
}

Vector2d Layout::cell_center(int x, int y) const {
  return {(x + 0.5) * kCell_m, (y + 0.5) * kCell_m};
}

double Layout::floor_area_m2() const {
  double area = (rect_.x1 - rect_.x0) * (rect_.y1 - rect_.y0);
  if (cut_) area -= (cut_->x1 - cut_->x0) * (cut_->y1 - cut_->y0);
  return area;
}

bool Layout::add_opening(const WallRun& wall, WallOpening opening) {
  constexpr double kApart_m = 0.2, kCorner_m = 0.12;
  if (opening.from_m < wall.from_m + kCorner_m || opening.to_m > wall.to_m - kCorner_m)
    return false;
  opening.side = wall.side;
  for (const WallOpening& other : openings_)
    if (other.side == opening.side && opening.from_m < other.to_m + kApart_m &&
        opening.to_m > other.from_m - kApart_m)
      return false;
  if (opening.door) {
    const double middle = 0.5 * (opening.from_m + opening.to_m);
    const Footprint swing = footprint_of(wall.place(middle, kDoorSwing_m, 0), wall.turn_deg(),
                                         opening.to_m - opening.from_m + 0.1, kDoorSwing_m);
    if (!inside(swing)) return false;
    swings_.push_back(swing);
  }
  openings_.push_back(std::move(opening));
  return true;
}

bool Layout::inside(const Footprint& footprint) const {
  for (const Vector2d& corner : footprint)
    if (!rect_.contains(corner, 1e-9)) return false;
  return !cut_ || overlap_m(footprint, rectangle(*cut_)) <= 1e-9;
}

bool Layout::belong_together(const LayoutItem& item, std::size_t i) const {
  const LayoutItem& other = items_[i];
  if (item.under == i) return true;
  // If a chair is pushed under a table, its box may intersect the box of a thing on the table: the
  // only part of the chair that reaches that high is its back, which is next to the table.
  if (item.under && other.on == item.under) return true;
  if (item.on && other.under == item.on) return true;
  for (std::optional<std::size_t> below = item.on; below; below = items_[*below].on)
    if (below == i) return true;
  return false;
}

bool Layout::apart(const LayoutItem& item) const {
  const auto is_rug = [](const LayoutItem& i) { return i.kind->name == "rug"; };
  for (std::size_t i = 0; i < items_.size(); ++i) {
    const LayoutItem& other = items_[i];
    // Two rugs must not overlap; everything else may stand on them.
    if (belong_together(item, i) || is_rug(item) != is_rug(other)) continue;
    const double low = std::max(item.z_m, other.z_m);
    const double high = std::min(item.z_m + item.size_m.z(), other.z_m + other.size_m.z());
    if (high - low <= 1e-9) continue;
    if (overlap_m(item.footprint(), other.footprint()) > -kApart_m) return false;
  }
  return true;
}

bool Layout::leaves_openings(const LayoutItem& item) const {
  const Footprint footprint = item.footprint();
  const double top = item.z_m + item.size_m.z();
  for (const WallOpening& o : openings_) {
    if (item.z_m >= o.high_m || top <= o.low_m + 0.05) continue;
    const WallRun& wall = walls_[static_cast<std::size_t>(o.side)];
    const double depth = 0.35;  // of the space kept free in front of an opening
    const Footprint before = footprint_of(wall.place(0.5 * (o.from_m + o.to_m), depth, 0),
                                          wall.turn_deg(), o.to_m - o.from_m, depth);
    if (overlap_m(footprint, before) > 0) return false;
  }
  return true;
}

bool Layout::in_the_way(const LayoutItem& item) const {
  return !item.on && item.size_m.z() > kFlat_m && item.z_m < kRobotHeight_m;
}

void Layout::narrow(Grid2d<float>& room, const Footprint& footprint) const {
  constexpr double kReach_m = kRobotRadius_m + kPlay_m;  // farther obstacles are irrelevant
  double x0 = 1e30, y0 = 1e30, x1 = -1e30, y1 = -1e30;
  for (const Vector2d& p : footprint) {
    x0 = std::min(x0, p.x()), x1 = std::max(x1, p.x());
    y0 = std::min(y0, p.y()), y1 = std::max(y1, p.y());
  }
  const auto cell = [](double v) { return static_cast<int>(std::floor(v / kCell_m)); };
  for (int y = std::max(0, cell(y0 - kReach_m));
       y <= std::min(room.height() - 1, cell(y1 + kReach_m)); ++y)
    for (int x = std::max(0, cell(x0 - kReach_m));
         x <= std::min(room.width() - 1, cell(x1 + kReach_m)); ++x)
      if (room(x, y) > 0.9 * kRobotRadius_m)  // smaller distances never suffice for the robot
        room(x, y) =
            std::min(room(x, y), static_cast<float>(distance_m(cell_center(x, y), footprint)));
}

bool Layout::connected(const Grid2d<float>& room, double radius_m) const {
  std::vector<std::pair<int, int>> stack;
  Grid2d<char> seen(room.width(), room.height(), 0);
  int free = 0, reached = 0;
  for (int y = 0; y < room.height(); ++y)
    for (int x = 0; x < room.width(); ++x) {
      if (room(x, y) < radius_m) continue;
      if (free++ == 0) {
        stack.emplace_back(x, y);
        seen(x, y) = 1;
      }
    }
  while (!stack.empty()) {
    const auto [x, y] = stack.back();
    stack.pop_back();
    ++reached;
    constexpr std::array<std::pair<int, int>, 4> kSteps = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    for (const auto& [dx, dy] : kSteps) {
      const int nx = x + dx, ny = y + dy;
      if (nx < 0 || ny < 0 || nx >= room.width() || ny >= room.height()) continue;
      if (room(nx, ny) < radius_m || seen(nx, ny)) continue;
      seen(nx, ny) = 1;
      stack.emplace_back(nx, ny);
    }
  }
  return free > 0 && reached == free;
}

std::optional<std::size_t> Layout::add(const LayoutItem& item, double front_m) {
  const Footprint footprint = item.footprint();
  if (!inside(footprint) || item.z_m + item.size_m.z() > height_m_ + 1e-9) return std::nullopt;
  if (!apart(item)) return std::nullopt;
  if (!item.on) {
    const bool hinders = in_the_way(item);
    if (item.kind->mount != Mount::kCeiling && !item.covers_window && !leaves_openings(item))
      return std::nullopt;
    const auto covers = [&](const Footprint& kept) { return overlap_m(footprint, kept) > 0; };
    if (hinders && std::ranges::any_of(swings_, covers)) return std::nullopt;
    if (hinders && !item.under && std::ranges::any_of(fronts_, covers)) return std::nullopt;
    std::optional<Footprint> front;
    if (front_m > 0) {
      front = footprint_of(
          from_frame(item.at_m, item.turn_deg, {0, -0.5 * (item.size_m.y() + front_m) - 0.002}),
          item.turn_deg, item.size_m.x(), front_m);
      if (!inside(*front)) return std::nullopt;
      for (const LayoutItem& other : items_)
        if (in_the_way(other) && overlap_m(*front, other.footprint()) > 0) return std::nullopt;
    }
    if (hinders) {
      Grid2d<float> after = room_m_;
      narrow(after, footprint);
      // All floor that is wide enough for the robot must be connected, both with and without the
      // clearance. Plans are in whole millimeters, so that a gap can be exactly as wide as the
      // robot: the test must also pass for slightly smaller and larger radii, so that rounding does
      // not decide it.
      constexpr double kTie_m = 0.0002;
      for (const double radius : {kRobotRadius_m, kRobotRadius_m + kPlay_m})
        for (const double tie : {-kTie_m, kTie_m})
          if (!connected(after, radius + tie)) return std::nullopt;
      room_m_ = std::move(after);
    }
    if (front) fronts_.push_back(*front);
  }
  items_.push_back(item);
  return items_.size() - 1;
}

double Layout::free_share() const {
  const auto free =
      std::ranges::count_if(room_m_, [](float room) { return room >= kRobotRadius_m + kPlay_m; });
  return static_cast<double>(free) * kCell_m * kCell_m / floor_area_m2();
}

int Layout::object_count() const {
  const auto pieces = std::ranges::count(items_, false, &LayoutItem::fitting);
  return static_cast<int>(pieces) + static_cast<int>(openings_.size());
}

}  // namespace mh
