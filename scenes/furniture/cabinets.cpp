// SPDX-License-Identifier: Apache-2.0
// Cases with doors and drawers.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector3f;

namespace {

/// A framed door (stile, rail and panel) in the plane y, facing -y, with a handle on one side.
void panel_door(Piece& p, MaterialId wood, MaterialId metal, const Front& front, bool handle_right,
                float stile = 0.055F) {
  const auto& [x0, x1, y, z0, z1] = front;
  MeshBuilder& m = p.mesh;
  const float t = 0.018F, s = stile;
  const BoxStyle up{.bevel_m = 0.004F, .grain_axis = 2}, along{.bevel_m = 0.004F, .grain_axis = 0};
  m.box(wood, {x0, y - t, z0}, {x0 + s, y, z1}, up);
  m.box(wood, {x1 - s, y - t, z0}, {x1, y, z1}, up);
  m.box(wood, {x0 + s, y - t, z0}, {x1 - s, y, z0 + s}, along);
  m.box(wood, {x0 + s, y - t, z1 - s}, {x1 - s, y, z1}, along);
  m.box(wood, {x0 + s, y - 0.010F, z0 + s}, {x1 - s, y - 0.002F, z1 - s},
        {.bevel_m = 0.0F, .grain_axis = 2});
  const float hx = handle_right ? x1 - s / 2 : x0 + s / 2, middle = 0.5F * (z0 + z1);
  const float reach = std::min(0.08F, 0.3F * (z1 - z0));
  handle(p, metal, {hx, y - t, middle - reach}, {hx, y - t, middle + reach});
}

void drawer_front(Piece& p, MaterialId wood, MaterialId metal, const Front& front) {
  const auto& [x0, x1, y, z0, z1] = front;
  p.mesh.box(wood, {x0, y - 0.018F, z0}, {x1, y, z1}, {.bevel_m = 0.005F, .grain_axis = 0});
  const float x = 0.5F * (x0 + x1), reach = std::min(0.07F, 0.2F * (x1 - x0)), z = 0.5F * (z0 + z1);
  handle(p, metal, {x - reach, y - 0.018F, z}, {x + reach, y - 0.018F, z});
}

/// Builds the base and the closed case behind the fronts of doors and drawers; returns the y of the
/// backs of these fronts.
float closed_case(Piece& p, MaterialId wood, float plinth, float top) {
  const float x = p.size_m.x() / 2, y = p.size_m.y() / 2, h = p.size_m.z();
  const float front = -y + 0.055F;  // fronts and handles stay inside the footprint
  MeshBuilder& m = p.mesh;
  if (plinth > 0.0F) m.box(wood, {-x + 0.02F, front + 0.02F, 0}, {x - 0.02F, y, plinth - 0.001F});
  m.box(wood, {-x + 0.002F, front, plinth}, {x - 0.002F, y, h - top - 0.001F}, {.grain_axis = 2});
  if (top > 0.0F) {
    m.max_edge_m = 0.08F;
    m.box(wood, {-x, front - 0.022F, h - top}, {x, y, h}, {.bevel_m = 0.005F, .grain_axis = 0});
    m.max_edge_m = 0.12F;
  }
  return front - 0.001F;
}

}  // namespace

void sideboard(Piece& p) {
  const float w = p.size_m.x(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak()), grip = grip_metal(p);
  const float y = closed_case(p, wood, 0.08F, 0.025F);
  const float drawers = h - 0.03F - 0.17F;
  const int n = std::max(2, static_cast<int>(std::lround(w / 0.45F)));
  const float each = (w - 0.02F) / static_cast<float>(n);
  for (int i = 0; i < n; ++i) {
    const float x0 = -w / 2 + 0.01F + each * static_cast<float>(i) + 0.003F,
                x1 = x0 + each - 0.006F;
    panel_door(p, wood, grip, {x0, x1, y, 0.09F, drawers - 0.003F}, i % 2 == 0);
    drawer_front(p, wood, grip, {x0, x1, y, drawers + 0.003F, h - 0.032F});
  }
}

void dresser(Piece& p) {
  const float w = p.size_m.x(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak()), grip = grip_metal(p);
  const float y = closed_case(p, wood, 0.07F, 0.025F);
  const int rows = std::max(3, static_cast<int>(std::lround((h - 0.1F) / 0.19F)));
  const float each = (h - 0.08F - 0.035F) / static_cast<float>(rows);
  for (int i = 0; i < rows; ++i) {
    const float z0 = 0.08F + each * static_cast<float>(i) + 0.003F, z1 = z0 + each - 0.006F;
    if (i == rows - 1) {  // two small drawers on top
      drawer_front(p, wood, grip, {-w / 2 + 0.012F, -0.003F, y, z0, z1});
      drawer_front(p, wood, grip, {0.003F, w / 2 - 0.012F, y, z0, z1});
    } else {
      drawer_front(p, wood, grip, {-w / 2 + 0.012F, w / 2 - 0.012F, y, z0, z1});
    }
  }
}

void wardrobe(Piece& p) {
  const float w = p.size_m.x(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak()), grip = grip_metal(p);
  const float y = closed_case(p, wood, 0.08F, 0.03F);
  panel_door(p, wood, grip, {-w / 2 + 0.008F, -0.003F, y, 0.30F, h - 0.04F}, true, 0.07F);
  panel_door(p, wood, grip, {0.003F, w / 2 - 0.008F, y, 0.30F, h - 0.04F}, false, 0.07F);
  drawer_front(p, wood, grip, {-w / 2 + 0.008F, w / 2 - 0.008F, y, 0.09F, 0.294F});
}

void cupboard(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak()), grip = grip_metal(p);
  const MaterialId china = p.material("china", plain("ceramic", {222, 222, 216}, 0.2, 75));
  const MaterialId blue = p.fixed(plain("ceramic", {72, 100, 150}, 0.3, 76));
  MeshBuilder& m = p.mesh;
  const float x = w / 2, y = d / 2, split = 0.86F;
  // Below: doors. Above: a shallower open case with china.
  m.box(wood, {-x + 0.02F, -y + 0.075F, 0}, {x - 0.02F, y, 0.079F});
  m.box(wood, {-x + 0.002F, -y + 0.055F, 0.08F}, {x - 0.002F, y, split - 0.026F},
        {.grain_axis = 2});
  m.box(wood, {-x, -y + 0.033F, split - 0.025F}, {x, y, split},
        {.bevel_m = 0.005F, .grain_axis = 0});
  panel_door(p, wood, grip, {-x + 0.008F, -0.003F, -y + 0.054F, 0.09F, split - 0.032F}, true);
  panel_door(p, wood, grip, {0.003F, x - 0.008F, -y + 0.054F, 0.09F, split - 0.032F}, false);
  const float front = -y + 0.10F;
  for (const float s : {-1.0F, 1.0F})
    m.box(wood, {s * (x - 0.012F) - 0.01F, front, split + 0.0005F},
          {s * (x - 0.012F) + 0.01F, y, h - 0.0255F}, {.grain_axis = 2});
  m.box(wood, {-x, front - 0.02F, h - 0.025F}, {x, y, h}, {.bevel_m = 0.006F, .grain_axis = 0});
  m.box(wood, {-x + 0.0225F, y - 0.012F, split + 0.0005F}, {x - 0.0225F, y, h - 0.0255F},
        {.bevel_m = 0.0F, .grain_axis = 2});
  const float pitch = (h - 0.025F - split) / 3.0F;
  for (int i = 0; i < 3; ++i) {
    const float z = split + pitch * static_cast<float>(i);
    if (i > 0)
      m.box(wood, {-x + 0.0225F, front + 0.01F, z - 0.02F}, {x - 0.0225F, y - 0.0125F, z},
            {.grain_axis = 0});
    for (int k = 0; k < 5; ++k) {
      const RandomStream r = p.random.fork(static_cast<std::uint64_t>(60 + 10 * i + k));
      const float cx = -x + 0.12F + static_cast<float>(k) * (w - 0.24F) / 4.0F;
      const MaterialId stuff = r.uniform(0) < 0.3 ? blue : china;
      if (i == 1) {  // plates standing on edge at the back
        p.part(fmt::format("plate_{}", k + 1), "bowl");
        m.push(translation(cx, y - 0.05F, z + 0.101F) * turn(Vector3f::UnitX(), 1.35F));
        const std::array<Eigen::Vector2f, 5> plate = {
            {{0.001F, 0}, {0.06F, 0}, {0.098F, 0.014F}, {0.06F, 0.006F}, {0.001F, 0.006F}}};
        m.lathe(stuff, {0, 0, 0}, plate, 20);
        m.pop();
      } else {
        p.part(fmt::format("cup_{}_{}", i + 1, k + 1), "cup");
        const float rr = static_cast<float>(r.uniform(1, 0.035, 0.05)),
                    tall = static_cast<float>(r.uniform(2, 0.07, 0.13));
        const std::array<Eigen::Vector2f, 6> cup = {{{0.001F, 0},
                                                     {0.7F * rr, 0},
                                                     {rr, 0.4F * tall},
                                                     {rr, tall},
                                                     {0.9F * rr, tall - 0.003F},
                                                     {0.001F, 0.2F * tall}}};
        m.lathe(stuff, {cx, front + 0.13F, z + 0.001F}, cup, 16);
      }
      p.body();
    }
  }
}

void box(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("plaster", {178, 142, 100}, 0.4, 78));
  const MaterialId tape = p.fixed(plain("plastic", {206, 186, 140}, 0.2, 5));
  MeshBuilder& m = p.mesh;
  m.box(body, {-w / 2 + 0.002F, -d / 2 + 0.002F, 0}, {w / 2 - 0.002F, d / 2 - 0.002F, h - 0.006F},
        {.bevel_m = 0.006F});
  m.box(body, {-w / 2, -d / 2, h - 0.05F}, {w / 2, d / 2, h - 0.002F}, {.bevel_m = 0.004F});  // lid
  m.box(tape, {-0.022F, -d / 2 - 0.0005F + 0.001F, h - 0.004F}, {0.022F, d / 2 - 0.001F, h},
        {.bevel_m = 0.0F});
}

}  // namespace mh::build
