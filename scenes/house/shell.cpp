// SPDX-License-Identifier: Apache-2.0
#include "scenes/house/shell.hpp"

#include <algorithm>
#include <cassert>

#include <fmt/format.h>

namespace mh {
namespace {

using Eigen::Vector3f;

constexpr float kWallStep = 0.075F;  // fine enough for the shadows of furniture on walls and floors
constexpr float kCeilingStep = 0.12F;
constexpr float kHullStep = 0.8F;
constexpr float kJamb = 0.03F;     // thickness of the lining of a doorway or window
constexpr float kCasing = 0.065F;  // visible width of the boards around it
constexpr float kProud = 0.012F;   // how far they protrude from the wall
constexpr float kBaseboard = 0.07F;

ClassId class_id(std::string_view name) {
  const auto id = class_by_name(name);
  assert(id);
  return *id;
}

/// Frame of a wall: `along` is the world coordinate along the wall, `in` points into the room,
/// `face` is the wall's inner face.
struct WallFrame {
  Side side;
  float face;
  bool along_x() const { return runs_along_x(side); }
  float in() const { return static_cast<float>(inward(side)); }
  /// World point at `along`, `depth` behind the face (into the wall), height z.
  Vector3f at(float along, float depth, float z) const {
    const float across = face - in() * depth;
    return along_x() ? Vector3f(along, across, z) : Vector3f(across, along, z);
  }
};

WallFrame wall_frame(const FloorRect& rect, Side side) {
  return {side, static_cast<float>(wall_at(rect, side))};
}

/// A box from two opposite corners in any order.
void board(MeshBuilder& mesh, MaterialId material, const Vector3f& a, const Vector3f& b,
           float bevel_m = 0.003F) {
  mesh.box(material, a.cwiseMin(b), a.cwiseMax(b), {.bevel_m = bevel_m});
}

struct Hole {
  float from, to, low, high;
};

/// The face of a wall with its holes.
struct WallSheet {
  Hole extent;
  std::vector<Hole> holes = {};
  bool inwards = true;  ///< visible from the room
  float step_m = kWallStep;
};

void wall_sheet(MeshBuilder& mesh, MaterialId material, const WallFrame& wall,
                const WallSheet& sheet) {
  const auto& [from, to, low, high] = sheet.extent;
  const std::vector<Hole>& holes = sheet.holes;
  const float step = sheet.step_m / mesh.detail;
  // u runs to the right as seen by someone facing the wall.
  const bool forward = ((wall.side == Side::kNorth || wall.side == Side::kWest) == sheet.inwards);
  const float sign = forward ? 1.0F : -1.0F;
  std::vector<float> u_stops, v_stops;
  for (const Hole& hole : holes) {
    u_stops.push_back(sign * hole.from);
    u_stops.push_back(sign * hole.to);
    v_stops.push_back(hole.low);
    v_stops.push_back(hole.high);
  }
  const std::vector<float> us = breaks(forward ? from : -to, forward ? to : -from, step, u_stops);
  const std::vector<float> vs = breaks(low, high, step, v_stops);
  const Vector3f origin = wall.along_x() ? Vector3f(0, wall.face, 0) : Vector3f(wall.face, 0, 0);
  const Vector3f axis = sign * (wall.along_x() ? Vector3f::UnitX() : Vector3f::UnitY());
  mesh.panel(material, {origin, axis, Vector3f::UnitZ()}, us, vs, [&](float u, float v) {
    return std::ranges::any_of(holes, [&](const Hole& h) {
      return sign * u > h.from && sign * u < h.to && v > h.low && v < h.high;
    });
  });
}

Hole hole_of(const OpeningPlan& opening) {
  return {static_cast<float>(opening.from_m), static_cast<float>(opening.to_m),
          static_cast<float>(opening.low_m), static_cast<float>(opening.high_m)};
}

/// Whether a doorway goes through the wall on that side of a room.
bool pierces(const HousePlan& house, const OpeningPlan& opening, std::size_t room, Side side) {
  if (opening.room == room) return opening.side == side;
  if (opening.other != room) return false;
  const FloorRect &a = house.rooms[opening.room].rect, &b = house.rooms[room].rect;
  switch (opening.side) {  // as seen from the other room
    case Side::kSouth:
      return side == Side::kNorth && b.y1 < a.y0;
    case Side::kNorth:
      return side == Side::kSouth && b.y0 > a.y1;
    case Side::kWest:
      return side == Side::kEast && b.x1 < a.x0;
    case Side::kEast:
      return side == Side::kWest && b.x0 > a.x1;
  }
  return false;
}

void build_baseboard(MeshBuilder& mesh, MaterialId material, const WallFrame& wall, float from,
                     float to, const std::vector<Hole>& holes) {
  // Baseboards along y stop short of the corners, where they meet those along x.
  const float corner = wall.along_x() ? 0.0F : kProud + 0.0005F;
  std::vector<std::pair<float, float>> gaps;
  for (const Hole& hole : holes)
    if (hole.low < kBaseboard) gaps.emplace_back(hole.from - kCasing, hole.to + kCasing);
  std::ranges::sort(gaps);
  float start = from + corner;
  gaps.emplace_back(to - corner, to);
  for (const auto& [gap_from, gap_to] : gaps) {
    if (gap_from - start > 0.02F)
      board(mesh, material, wall.at(start, 0.004F, -0.004F),
            wall.at(gap_from, -kProud, kBaseboard));
    start = gap_to;
  }
}

void build_room(const HousePlan& house, std::size_t index, MaterialId trim, MeshBuilder& mesh) {
  const RoomPlan& room = house.rooms[index];
  const auto x0 = static_cast<float>(room.rect.x0), x1 = static_cast<float>(room.rect.x1);
  const auto y0 = static_cast<float>(room.rect.y0), y1 = static_cast<float>(room.rect.y1);
  const auto top = static_cast<float>(house.height_m);
  const float fine = kWallStep / mesh.detail, coarse = kCeilingStep / mesh.detail;
  std::vector<float> x_stops, y_stops;
  if (room.cut) {
    x_stops = {static_cast<float>(room.cut->x0), static_cast<float>(room.cut->x1)};
    y_stops = {static_cast<float>(room.cut->y0), static_cast<float>(room.cut->y1)};
  }
  const auto missing = [&](float x, float y) { return room.cut && room.cut->contains({x, y}); };
  mesh.begin_instance(room.name + "/floor", class_id("floor"));
  mesh.panel(mesh.material(room.floor), {Vector3f::Zero(), Vector3f::UnitX(), Vector3f::UnitY()},
             breaks(x0, x1, fine, x_stops), breaks(y0, y1, fine, y_stops), missing);
  mesh.begin_instance(room.name + "/ceiling", class_id("ceiling"));
  mesh.panel(mesh.material(room.ceiling), {{0, 0, top}, Vector3f::UnitY(), Vector3f::UnitX()},
             breaks(y0, y1, coarse, y_stops), breaks(x0, x1, coarse, x_stops),
             [&](float y, float x) { return missing(x, y); });
  for (const Side side : kSides) {
    const WallFrame wall = wall_frame(room.rect, side);
    std::vector<Hole> holes;
    for (const auto* list : {&house.doorways, &house.windows})
      for (const OpeningPlan& opening : *list)
        if (pierces(house, opening, index, side)) holes.push_back(hole_of(opening));
    float from = wall.along_x() ? x0 : y0, to = wall.along_x() ? x1 : y1;
    const MaterialId paint = mesh.material(room.walls[static_cast<std::size_t>(side)]);
    if (room.cut) {
      const WallFrame inner = wall_frame(*room.cut, opposite(side));
      const WallFrame behind = wall_frame(*room.cut, side);
      const FloorRect& c = *room.cut;
      const auto a = static_cast<float>(wall.along_x() ? c.x0 : c.y0);
      const auto b = static_cast<float>(wall.along_x() ? c.x1 : c.y1);
      if (behind.face == wall.face) {  // this wall ends where the missing corner begins
        (a <= from ? from : to) = a <= from ? b : a;
        const WallFrame across{side, inner.face};
        mesh.begin_instance(fmt::format("{}/wall_inner_{}", room.name, side_name(side)),
                            class_id("wall"));
        wall_sheet(mesh, paint, across, {.extent = {a, b, 0.0F, top}});
        build_baseboard(mesh, trim, across, a, b, {});
      }
    }
    mesh.begin_instance(fmt::format("{}/wall_{}", room.name, side_name(side)), class_id("wall"));
    wall_sheet(mesh, paint, wall, {.extent = {from, to, 0.0F, top}, .holes = holes});
    build_baseboard(mesh, trim, wall, from, to, holes);
  }
}

/// Boards that line a hole through the wall, and casings around it, each between two depths.
struct Lining {
  float back;  ///< how far it reaches behind the wall's face
  bool below;
  std::vector<std::pair<float, float>> casings;
};

void build_lining(MeshBuilder& mesh, MaterialId wood, const WallFrame& wall, const Hole& h,
                  const Lining& lining) {
  const auto& [back, below, casings] = lining;
  const float a = h.from, b = h.to;
  board(mesh, wood, wall.at(a - 0.004F, -kProud + 0.005F, h.low), wall.at(a + kJamb, back, h.high));
  board(mesh, wood, wall.at(b - kJamb, -kProud + 0.005F, h.low), wall.at(b + 0.004F, back, h.high));
  board(mesh, wood, wall.at(a + kJamb, -kProud + 0.005F, h.high - kJamb),
        wall.at(b - kJamb, back, h.high + 0.004F));
  if (below)
    board(mesh, wood, wall.at(a + kJamb, -kProud + 0.005F, h.low - 0.004F),
          wall.at(b - kJamb, back, h.low + kJamb));
  for (const auto& [d0, d1] : casings) {
    const float foot = below ? h.low - kCasing : 0.0F;
    board(mesh, wood, wall.at(a - kCasing, d0, foot), wall.at(a + 0.012F, d1, h.high - 0.012F));
    board(mesh, wood, wall.at(b - 0.012F, d0, foot), wall.at(b + kCasing, d1, h.high - 0.012F));
    board(mesh, wood, wall.at(a - kCasing - 0.01F, d0, h.high - 0.0115F),
          wall.at(b + kCasing + 0.01F, d1, h.high + kCasing));
  }
}

void build_door_leaf(MeshBuilder& mesh, MaterialId wood, const WallFrame& wall, const Hole& h) {
  const MaterialId metal = mesh.material({.name = "door_handle",
                                          .kind = "brushed_metal",
                                          .tone = {186, 184, 178},
                                          .variation = 0.3,
                                          .seed = 7});
  const float a = h.from + kJamb + 0.003F, b = h.to - kJamb - 0.003F, low = 0.006F;
  const float high = h.high - kJamb - 0.003F, front = 0.03F, back = 0.07F;
  const float stile = 0.11F, middle = 0.95F;
  // Stiles, three rails and two recessed panels.
  board(mesh, wood, wall.at(a, front, low), wall.at(a + stile, back, high));
  board(mesh, wood, wall.at(b - stile, front, low), wall.at(b, back, high));
  for (const auto& [z0, z1] :
       {std::pair{low, 0.20F}, std::pair{middle, middle + 0.14F}, std::pair{high - 0.12F, high}})
    board(mesh, wood, wall.at(a + stile, front, z0), wall.at(b - stile, back, z1));
  for (const auto& [z0, z1] : {std::pair{0.20F, middle}, std::pair{middle + 0.14F, high - 0.12F}})
    mesh.box(wood, wall.at(a + stile, front + 0.014F, z0).cwiseMin(wall.at(b - stile, back, z1)),
             wall.at(a + stile, front + 0.014F, z0).cwiseMax(wall.at(b - stile, back, z1)),
             {.bevel_m = 0.0F, .grain_axis = 2});
  const float x = b - 0.06F, z = 1.0F;  // a plate, a spindle and a lever
  board(mesh, metal, wall.at(x - 0.022F, front - 0.006F, z - 0.09F),
        wall.at(x + 0.022F, front + 0.002F, z + 0.09F));
  mesh.cylinder(metal, wall.at(x, front, z + 0.03F), wall.at(x, front - 0.055F, z + 0.03F),
                {0.009F, 0.009F}, 10);
  mesh.cylinder(metal, wall.at(x + 0.01F, front - 0.05F, z + 0.03F),
                wall.at(x - 0.12F, front - 0.05F, z + 0.03F), {0.009F, 0.008F}, 10);
  mesh.cylinder(metal, wall.at(0.5F * (a + b), front + 0.002F, 1.52F),
                wall.at(0.5F * (a + b), front - 0.006F, 1.52F), {0.012F, 0.012F}, 12);
}

void build_doorway(const HousePlan& house, const OpeningPlan& door, MaterialId wood,
                   MeshBuilder& mesh) {
  const WallFrame wall = wall_frame(house.rooms[door.room].rect, door.side);
  const Hole hole = hole_of(door);
  const auto thick = static_cast<float>(house.wall_m);
  mesh.begin_instance(door.name, class_id("door"));
  std::vector<std::pair<float, float>> casings{{-kProud, 0.002F}};
  if (door.other) casings.emplace_back(thick - 0.002F, thick + kProud);
  const float back = door.other ? thick + kProud - 0.001F : thick - 0.005F;
  build_lining(mesh, wood, wall, hole, {back, false, casings});
  // Threshold: a flat board that covers the joint between the two floors.
  board(mesh, wood, wall.at(hole.from - 0.002F, -0.012F, -0.02F),
        wall.at(hole.to + 0.002F, back, 0.005F));
  if (door.closed) build_door_leaf(mesh, wood, wall, hole);
}

void build_window(const HousePlan& house, const OpeningPlan& window, MaterialId frame,
                  MeshBuilder& mesh) {
  const WallFrame wall = wall_frame(house.rooms[window.room].rect, window.side);
  const Hole h = hole_of(window);
  const auto thick = static_cast<float>(house.wall_m);
  mesh.begin_instance(window.name, class_id("window"));
  build_lining(mesh, frame, wall, h,
               {thick + 0.01F, true, {{-kProud, 0.002F}, {thick - 0.002F, thick + kProud}}});
  // Inner sill.
  board(mesh, frame, wall.at(h.from - kCasing - 0.01F, -0.028F, h.low - 0.001F),
        wall.at(h.to + kCasing + 0.01F, 0.004F, h.low + kJamb + 0.004F), 0.005F);
  // Sashes: each pane has a frame of its own and a bar across.
  const float a = h.from + kJamb, b = h.to - kJamb, low = h.low + kJamb, high = h.high - kJamb;
  const float each = (b - a) / static_cast<float>(window.panes), bar = 0.045F;
  for (int i = 0; i < window.panes; ++i) {
    const float p = a + each * static_cast<float>(i), q = p + each;
    const float d0 = i % 2 == 0 ? 0.035F : 0.062F,
                d1 = d0 + 0.026F;  // sliding: one behind the other
    const float lap = window.panes > 1 ? 0.02F : 0.0F;
    const float l = i == 0 ? p : p - lap, r = i + 1 == window.panes ? q : q + lap;
    board(mesh, frame, wall.at(l, d0, low), wall.at(l + bar, d1, high));
    board(mesh, frame, wall.at(r - bar, d0, low), wall.at(r, d1, high));
    board(mesh, frame, wall.at(l + bar, d0, low), wall.at(r - bar, d1, low + bar));
    board(mesh, frame, wall.at(l + bar, d0, high - bar), wall.at(r - bar, d1, high));
    const float middle = high - 0.36F * (high - low);
    board(mesh, frame, wall.at(l + bar, d0 + 0.005F, middle),
          wall.at(r - bar, d1 - 0.005F, middle + 0.022F));
  }
}

/// Outer faces, roof and ground slab of a box that is `inset` inside the hull's outermost box.
void build_hull_layer(const HousePlan& house, MaterialId material, float inset, bool outwards,
                      MeshBuilder& mesh) {
  const float t = static_cast<float>(house.wall_m) - inset;
  const float top = static_cast<float>(house.height_m) + 0.1F - inset, bottom = -0.12F + inset;
  FloorRect outer = house.extent;
  outer.x0 -= t, outer.y0 -= t, outer.x1 += t, outer.y1 += t;
  const auto x0 = static_cast<float>(outer.x0), x1 = static_cast<float>(outer.x1);
  const auto y0 = static_cast<float>(outer.y0), y1 = static_cast<float>(outer.y1);
  const auto xs = breaks(x0, x1, kHullStep), ys = breaks(y0, y1, kHullStep);
  const std::string suffix = outwards ? "" : "_inside";
  mesh.begin_instance("house/outer_walls" + suffix, class_id("wall"));
  for (const Side side : kSides) {
    std::vector<Hole> holes;
    for (const OpeningPlan& window : house.windows)
      if (window.side == side) holes.push_back(hole_of(window));
    const WallFrame wall = wall_frame(outer, side);
    wall_sheet(mesh, material, wall,
               {.extent = {wall.along_x() ? x0 : y0, wall.along_x() ? x1 : y1, bottom, top},
                .holes = holes,
                .inwards = !outwards,
                .step_m = kHullStep});
  }
  if (!outwards) return;  // only walls: nothing stands beyond floors and ceilings
  mesh.begin_instance("house/roof", class_id("ceiling"));
  mesh.panel(material, {{0, 0, top}, Vector3f::UnitX(), Vector3f::UnitY()}, xs, ys);
  mesh.begin_instance("house/slab", class_id("otherstructure"));
  mesh.panel(material, {{0, 0, bottom}, Vector3f::UnitY(), Vector3f::UnitX()}, ys, xs);
}

/// Puts something dark behind every joint between the rooms' surfaces. One layer is not enough:
/// light is stored per vertex for both sides of a face, so sunlight on the outside would make the
/// inside glow.
void build_hull(const HousePlan& house, MeshBuilder& mesh) {
  const MaterialId render = mesh.material({.name = "outer_render",
                                           .kind = "plaster",
                                           .tone = {206, 200, 190},
                                           .variation = 0.3,
                                           .seed = 99});
  const MaterialId black = mesh.material(
      {.name = "hull_inside", .kind = "plastic", .tone = {6, 6, 6}, .variation = 0.0});
  build_hull_layer(house, render, 0.0F, true, mesh);
  build_hull_layer(house, black, 0.01F, false, mesh);
}

/// A glowing image of a garden is placed beyond each side that has windows, with a lawn in front.
/// Each side has its own image, as wide as the side, so that no window repeats another's view.
/// Images and lawn do not belong in a map of the house, so their class is void and they belong to
/// no object.
void build_garden(const HousePlan& house, const GardenPlan& garden, MeshBuilder& mesh) {
  const auto d = static_cast<float>(garden.distance_m), h = static_cast<float>(garden.height_m);
  const auto glow = static_cast<float>(garden.glow);
  const FloorRect& e = house.extent;
  const auto x0 = static_cast<float>(e.x0) - d, x1 = static_cast<float>(e.x1) + d;
  const auto y0 = static_cast<float>(e.y0) - d, y1 = static_cast<float>(e.y1) + d;
  constexpr float kGround = -0.35F;
  // With the exposure set for indoors, the outside would be too bright, so all images are darkened.
  // Only images on sides without sun get the emission `glow`.
  const auto image = [&](Side side, float width_m, bool sunlit) {
    MaterialSpec spec = garden.material;
    spec.name = fmt::format("{}_{}", spec.name, side_name(side));
    spec.seed += static_cast<std::uint64_t>(side);
    spec.size_m = {width_m, h - kGround};
    const MaterialId id =
        sunlit ? mesh.material(spec) : mesh.material(spec, glow * Vector3f(0.85F, 1.0F, 1.0F));
    const std::uint8_t tone = sunlit ? 124 : 146;
    mesh.scene().materials[id].base_color = {tone, tone, tone};
    return id;
  };
  const MaterialId lawn = mesh.material(
      {.name = "lawn", .kind = "carpet", .tone = {96, 118, 66}, .variation = 0.6, .seed = 98});
  mesh.scene().materials[lawn].base_color = {88, 88, 88};
  mesh.resume_instance(0);
  FloorRect far{x0, y0, x1, y1};
  for (const Side side : kSides) {
    if (std::ranges::none_of(house.windows, [&](const auto& w) { return w.side == side; }))
      continue;
    const WallFrame wall = wall_frame(far, side);
    const Vector3f origin(wall.along_x() ? 0 : wall.face, wall.along_x() ? wall.face : 0, h);
    const bool forward = side == Side::kNorth || side == Side::kWest;
    const Vector3f axis =
        (forward ? 1.0F : -1.0F) * (wall.along_x() ? Vector3f::UnitX() : Vector3f::UnitY());
    const float from = wall.along_x() ? x0 : y0, to = wall.along_x() ? x1 : y1;
    const Vector3f normal = axis.cross(Vector3f::UnitZ());
    const bool lit = house.sun && house.sun->direction.dot(normal) < 0.0F;
    mesh.panel(image(side, to - from, lit), {origin, axis, Vector3f::UnitZ()},
               breaks(forward ? from : -to, forward ? to : -from, 1.0F),
               breaks(kGround - h, 0.0F, 1.0F));
  }
  mesh.panel(lawn, {{0, 0, kGround}, Vector3f::UnitX(), Vector3f::UnitY()}, breaks(x0, x1, 0.6F),
             breaks(y0, y1, 0.6F));
}

}  // namespace

void build_shell(const HousePlan& house, MeshBuilder& mesh) {
  const MaterialId trim = mesh.material(house.trim), frame = mesh.material(house.window_frame);
  for (std::size_t i = 0; i < house.rooms.size(); ++i) build_room(house, i, trim, mesh);
  for (const OpeningPlan& door : house.doorways) build_doorway(house, door, trim, mesh);
  for (const OpeningPlan& window : house.windows) build_window(house, window, frame, mesh);
  build_hull(house, mesh);
  if (house.garden) build_garden(house, *house.garden, mesh);
}

}  // namespace mh
