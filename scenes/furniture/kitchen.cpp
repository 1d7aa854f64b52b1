// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

MaterialSpec sink_steel() {
  return plain("brushed_metal", {172, 174, 176}, 0.4, 73);
}
MaterialSpec knob_plastic() {
  return plain("plastic", {30, 30, 32}, 0.2, 2);
}

/// A flat front with a bar handle near its upper edge.
void front(Piece& p, MaterialId stuff, MaterialId metal, const Front& place) {
  const auto& [x0, x1, y, z0, z1] = place;
  p.mesh.box(stuff, {x0, y - 0.019F, z0}, {x1, y, z1}, {.bevel_m = 0.004F, .grain_axis = 2});
  const float x = 0.5F * (x0 + x1), z = z1 - 0.05F, reach = 0.28F * (x1 - x0);
  handle(p, metal, {x - reach, y - 0.019F, z}, {x + reach, y - 0.019F, z}, 0.028F);
}

}  // namespace

void refrigerator(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("plastic", {206, 208, 210}, 0.2, 31));
  const MaterialId door = p.material("door", plain("brushed_metal", {196, 199, 202}, 0.25, 32));
  const MaterialId metal = p.fixed(sink_steel()), black = p.fixed(knob_plastic());
  MeshBuilder& m = p.mesh;
  const float x = w / 2, face = -d / 2 + 0.045F, split = 0.66F;
  m.box(body, {-x, face + 0.065F, 0.03F}, {x, d / 2, h}, {.bevel_m = 0.008F});
  m.box(black, {-x + 0.02F, face + 0.09F, 0}, {x - 0.02F, d / 2 - 0.02F, 0.0295F},
        {.bevel_m = 0.0F});
  // Two upper doors and two drawers below, with dark gaps between.
  m.box(black, {-x + 0.006F, face + 0.02F, 0.05F}, {x - 0.006F, face + 0.0645F, h - 0.01F},
        {.bevel_m = 0.0F});
  const BoxStyle soft{.bevel_m = 0.010F, .grain_axis = 2};
  m.box(door, {-x, face, split + 0.005F}, {-0.003F, face + 0.058F, h - 0.002F}, soft);
  m.box(door, {0.003F, face, split + 0.005F}, {x, face + 0.058F, h - 0.002F}, soft);
  m.box(door, {-x, face, 0.365F}, {x, face + 0.058F, split - 0.003F}, soft);
  m.box(door, {-x, face, 0.055F}, {x, face + 0.058F, 0.359F}, soft);
  handle(p, metal, {-0.035F, face, split + 0.20F}, {-0.035F, face, h - 0.35F}, 0.034F);
  handle(p, metal, {0.035F, face, split + 0.20F}, {0.035F, face, h - 0.35F}, 0.034F);
  handle(p, metal, {-0.22F, face, split - 0.05F}, {0.22F, face, split - 0.05F}, 0.034F);
  handle(p, metal, {-0.22F, face, 0.31F}, {0.22F, face, 0.31F}, 0.034F);
  m.box(black, {-0.62F * x, face - 0.002F, 1.22F}, {-0.32F * x, face + 0.01F, 1.36F},
        {.bevel_m = 0.001F});  // panel
  p.part("notes", "paper");    // notes and magnets
  for (int i = 0; i < 3; ++i) {
    const float nx = 0.12F + 0.05F * static_cast<float>(i % 2),
                nz = 1.50F - 0.17F * static_cast<float>(i);
    MaterialSpec paper = plain("paper", i == 1 ? Rgb8{238, 226, 150} : Rgb8{232, 230, 224}, 0.6,
                               400 + static_cast<unsigned>(i));
    paper.size_m = {0.11F, 0.14F};
    m.image(p.fixed(paper), {nx, face - 0.0025F, nz}, {0.11F, 0, 0}, {0, 0, -0.14F});
    m.cylinder(p.fixed(plain("plastic", i == 0 ? Rgb8{190, 50, 44} : Rgb8{50, 100, 170}, 0.1)),
               {nx + 0.055F, face - 0.0025F, nz - 0.015F},
               {nx + 0.055F, face - 0.010F, nz - 0.015F}, {0.010F, 0.010F}, 10);
  }
  p.body();
}

void kitchen_counter(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak());
  const MaterialId top = p.material("top", plain("stone", {142, 138, 130}, 0.45, 26));
  const MaterialId metal = p.fixed(sink_steel());
  MeshBuilder& m = p.mesh;
  const float x = w / 2, y0 = -d / 2 + 0.05F, zt = h - 0.035F;
  m.box(wood, {-x + 0.01F, y0 + 0.05F, 0}, {x - 0.01F, d / 2, 0.099F});
  // The case is hollow under the sink.
  m.box(wood, {-x, y0 + 0.001F, 0.10F}, {x, y0 + 0.02F, zt - 0.001F});
  m.box(wood, {-x, y0 + 0.0205F, 0.10F}, {-x + 0.02F, d / 2, zt - 0.001F}, {.grain_axis = 2});
  m.box(wood, {x - 0.02F, y0 + 0.0205F, 0.10F}, {x, d / 2, zt - 0.001F}, {.grain_axis = 2});
  // Fronts: a block of drawers, then doors.
  const float unit = w / 3.0F;
  for (int i = 0; i < 3; ++i) {
    const float a = -x + unit * static_cast<float>(i) + 0.003F, b = a + unit - 0.006F;
    if (i == 2) {
      front(p, wood, metal, {a, b, y0, 0.106F, 0.40F});
      front(p, wood, metal, {a, b, y0, 0.406F, 0.62F});
      front(p, wood, metal, {a, b, y0, 0.626F, zt - 0.006F});
    } else {
      front(p, wood, metal, {a, 0.5F * (a + b) - 0.0015F, y0, 0.106F, zt - 0.006F});
      front(p, wood, metal, {0.5F * (a + b) + 0.0015F, b, y0, 0.106F, zt - 0.006F});
    }
  }
  // Countertop around the basin.
  const float bx0 = -0.36F, bx1 = 0.30F, by0 = -0.20F, by1 = 0.18F, yf = -d / 2 + 0.012F;
  m.max_edge_m = 0.08F;
  const BoxStyle slab{.bevel_m = 0.003F, .grain_axis = 0};
  m.box(top, {-x, yf, zt}, {bx0, d / 2, h}, slab);
  m.box(top, {bx1, yf, zt}, {x, d / 2, h}, slab);
  m.box(top, {bx0 - 0.001F, yf, zt}, {bx1 + 0.001F, by0, h}, slab);
  m.box(top, {bx0 - 0.001F, by1, zt}, {bx1 + 0.001F, d / 2, h}, slab);
  m.box(top, {-x, d / 2 - 0.014F, h}, {x, d / 2, h + 0.06F - 0.06F + 0.05F}, slab);  // upstand
  m.max_edge_m = 0.12F;

  p.part("sink", "sink");
  const float deep = h - 0.19F, t = 0.008F;
  m.box(metal, {bx0 - 0.015F, by0 - 0.015F, h - 0.001F}, {bx1 + 0.015F, by0 + t, h + 0.004F},
        {.bevel_m = 0.002F});
  m.box(metal, {bx0 - 0.015F, by1 - t, h - 0.001F}, {bx1 + 0.015F, by1 + 0.015F, h + 0.004F},
        {.bevel_m = 0.002F});
  m.box(metal, {bx0 - 0.015F, by0 + t, h - 0.001F}, {bx0 + t, by1 - t, h + 0.004F},
        {.bevel_m = 0.002F});
  m.box(metal, {bx1 - t, by0 + t, h - 0.001F}, {bx1 + 0.015F, by1 - t, h + 0.004F},
        {.bevel_m = 0.002F});
  m.box(metal, {bx0 + 0.001F, by0 + 0.001F, deep}, {bx0 + t, by1 - 0.001F, h - 0.0015F},
        {.bevel_m = 0.0F});
  m.box(metal, {bx1 - t, by0 + 0.001F, deep}, {bx1 - 0.001F, by1 - 0.001F, h - 0.0015F},
        {.bevel_m = 0.0F});
  m.box(metal, {bx0 + t, by0 + 0.001F, deep}, {bx1 - t, by0 + t, h - 0.0015F}, {.bevel_m = 0.0F});
  m.box(metal, {bx0 + t, by1 - t, deep}, {bx1 - t, by1 - 0.001F, h - 0.0015F}, {.bevel_m = 0.0F});
  m.box(metal, {bx0 + 0.001F, by0 + 0.001F, deep - 0.006F}, {bx1 - 0.001F, by1 - 0.001F, deep},
        {.bevel_m = 0.0F});
  m.cylinder(p.fixed(knob_plastic()), {-0.03F, 0, deep}, {-0.03F, 0, deep + 0.004F},
             {0.04F, 0.035F}, 16);
  // Tap: a base, a swan neck and a lever.
  const float ty = by1 + 0.05F, tx = -0.03F;
  m.cylinder(metal, {tx, ty, h}, {tx, ty, h + 0.05F}, {0.024F, 0.022F}, 14);
  std::vector<Vector3f> neck{{tx, ty, h + 0.04F}, {tx, ty, h + 0.20F}};
  for (int i = 1; i <= 8; ++i) {
    const float a = 3.14159265F * static_cast<float>(i) / 8.0F;
    neck.emplace_back(tx, ty - 0.09F + 0.09F * std::cos(a), h + 0.20F + 0.09F * std::sin(a));
  }
  neck.emplace_back(tx, ty - 0.18F, h + 0.15F);
  m.tube(metal, neck, 0.011F, 10);
  m.cylinder(metal, {tx + 0.02F, ty, h + 0.035F}, {tx + 0.09F, ty - 0.01F, h + 0.06F},
             {0.007F, 0.006F}, 8);
  p.body();
}

void oven(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", sink_steel());
  const MaterialId black = p.fixed(knob_plastic());
  const MaterialId glass = p.fixed(plain("glass", {26, 28, 32}, 0.3, 41));
  const MaterialId metal = p.fixed(plain("brushed_metal", {200, 200, 200}, 0.3, 42));
  MeshBuilder& m = p.mesh;
  const float x = w / 2, y0 = -d / 2 + 0.05F;
  m.box(black, {-x + 0.01F, y0 + 0.06F, 0}, {x - 0.01F, d / 2, 0.089F});
  m.box(body, {-x, y0 + 0.03F, 0.09F}, {x, d / 2, h - 0.012F}, {.bevel_m = 0.003F});
  m.box(glass, {-x, -d / 2 + 0.02F, h - 0.0115F}, {x, d / 2, h}, {.bevel_m = 0.003F});  // cooktop
  for (const auto& [cx, cy, r] :
       {std::array{-0.14F, 0.13F, 0.075F}, std::array{0.14F, 0.13F, 0.095F},
        std::array{-0.14F, -0.13F, 0.095F}, std::array{0.14F, -0.13F, 0.075F}}) {
    std::vector<Vector3f> ring;  // cast supports around each burner
    for (int i = 0; i <= 20; ++i) {
      const float a = 6.28318531F * static_cast<float>(i % 20) / 20.0F;
      ring.emplace_back(cx + r * std::cos(a), cy + r * std::sin(a), h + 0.012F);
    }
    m.tube(black, ring, 0.005F, 6);
    m.cylinder(metal, {cx, cy, h}, {cx, cy, h + 0.010F}, {0.4F * r, 0.32F * r}, 14);
    for (int i = 0; i < 4; ++i) {
      const float a = 1.57079633F * static_cast<float>(i);
      m.beam(black, {cx + 0.45F * r * std::cos(a), cy + 0.45F * r * std::sin(a), h + 0.013F},
             {cx + 1.25F * r * std::cos(a), cy + 1.25F * r * std::sin(a), h + 0.013F}, 0.008F,
             0.010F, {0, 0, 1});
    }
  }
  m.box(body, {-x, y0 + 0.001F, h - 0.12F}, {x, y0 + 0.0295F, h - 0.013F},
        {.bevel_m = 0.003F});  // panel with the knobs
  for (int i = 0; i < 5; ++i) {
    const float kx = (static_cast<float>(i) - 2.0F) * 0.105F;
    m.cylinder(black, {kx, y0 + 0.002F, h - 0.066F}, {kx, y0 - 0.026F, h - 0.066F},
               {0.021F, 0.018F}, 14);
    m.box(metal, {kx - 0.002F, y0 - 0.028F, h - 0.066F}, {kx + 0.002F, y0 - 0.025F, h - 0.048F},
          {.bevel_m = 0.0F});
  }
  m.box(body, {-x + 0.004F, y0, 0.26F}, {x - 0.004F, y0 + 0.029F, h - 0.125F},
        {.bevel_m = 0.004F});  // door
  m.box(glass, {-x + 0.07F, y0 - 0.002F, 0.32F}, {x - 0.07F, y0 + 0.01F, h - 0.22F},
        {.bevel_m = 0.002F});
  handle(p, metal, {-x + 0.06F, y0, h - 0.165F}, {x - 0.06F, y0, h - 0.165F}, 0.038F);
  m.box(body, {-x + 0.004F, y0, 0.095F}, {x - 0.004F, y0 + 0.029F, 0.254F},
        {.bevel_m = 0.004F});  // drawer
}

void range_hood(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", sink_steel());
  const MaterialId black = p.fixed(knob_plastic());
  MeshBuilder& m = p.mesh;
  const float x = w / 2, y = d / 2;
  m.box(body, {-x, -y, 0}, {x, y, 0.06F}, {.bevel_m = 0.004F});
  m.box(black, {-x + 0.05F, -y + 0.05F, -0.002F + 0.0F}, {x - 0.05F, y - 0.05F, 0.001F},
        {.bevel_m = 0.0F});
  // A sloping canopy to the chimney.
  const float cx = 0.13F, cy = y - 0.24F, z0 = 0.06F, z1 = 0.30F;
  const std::array<Vector3f, 4> low = {{{-x, -y, z0}, {x, -y, z0}, {x, y, z0}, {-x, y, z0}}};
  const std::array<Vector3f, 4> high = {{{-cx, cy, z1}, {cx, cy, z1}, {cx, y, z1}, {-cx, y, z1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    m.sheet(body,
            [&](float s, float t) -> Vector3f {
              return (1 - t) * ((1 - s) * high[i] + s * high[j]) +
                     t * ((1 - s) * low[i] + s * low[j]);
            },
            4, 3, {w, 0.3F});
  }
  m.box(body, {-cx, cy, z1 - 0.002F}, {cx, y, h}, {.bevel_m = 0.002F, .grain_axis = 2});
  for (int i = 0; i < 4; ++i)
    m.cylinder(black, {-0.06F + 0.04F * static_cast<float>(i), -y + 0.002F, 0.03F},
               {-0.06F + 0.04F * static_cast<float>(i), -y - 0.0F + 0.0005F, 0.03F},
               {0.009F, 0.009F}, 10);
}

void wall_cabinet(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak());
  const MaterialId metal = p.fixed(sink_steel());
  const float x = w / 2, y0 = -d / 2 + 0.05F;
  p.mesh.box(wood, {-x, y0 + 0.001F, 0}, {x, d / 2, h}, {.grain_axis = 2});
  const int n = std::max(2, static_cast<int>(w / 0.42F));
  const float each = w / static_cast<float>(n);
  for (int i = 0; i < n; ++i) {
    const float a = -x + each * static_cast<float>(i) + 0.0025F, b = a + each - 0.005F;
    p.mesh.box(wood, {a, y0 - 0.019F, 0.003F}, {b, y0, h - 0.003F},
               {.bevel_m = 0.004F, .grain_axis = 2});
    const float hx = i % 2 == 0 ? b - 0.04F : a + 0.04F;
    handle(p, metal, {hx, y0 - 0.019F, 0.05F}, {hx, y0 - 0.019F, 0.19F}, 0.028F);
  }
}

void microwave(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("plastic", {222, 222, 220}, 0.2, 51));
  const MaterialId black = p.fixed(knob_plastic());
  const MaterialId glass = p.fixed(plain("glass", {34, 36, 40}, 0.3, 52));
  const MaterialId metal = p.fixed(sink_steel());
  MeshBuilder& m = p.mesh;
  const float x = w / 2, y = -d / 2 + 0.035F;
  m.box(body, {-x, y + 0.012F, 0.012F}, {x, d / 2, h}, {.bevel_m = 0.008F});
  for (const float sx : {-1.0F, 1.0F})
    for (const float sy : {-0.35F, 0.40F})
      m.cylinder(black, {sx * 0.4F * w, sy * d, 0}, {sx * 0.4F * w, sy * d, 0.014F},
                 {0.014F, 0.014F}, 8);
  m.box(body, {-x + 0.003F, y, 0.016F}, {x - 0.125F, y + 0.0115F, h - 0.006F}, {.bevel_m = 0.004F});
  m.box(glass, {-x + 0.04F, y - 0.002F, 0.055F}, {x - 0.165F, y + 0.004F, h - 0.045F},
        {.bevel_m = 0.001F});
  m.box(black, {x - 0.122F, y, 0.016F}, {x - 0.003F, y + 0.0115F, h - 0.006F}, {.bevel_m = 0.004F});
  m.box(p.fixed(plain("plastic", {60, 170, 150}, 0.1, 3), {0.05F, 0.4F, 0.3F}),
        {x - 0.105F, y - 0.001F, h - 0.07F}, {x - 0.02F, y + 0.003F, h - 0.035F},
        {.bevel_m = 0.0F});
  for (int i = 0; i < 9; ++i) {
    const float bx = x - 0.095F + 0.030F * static_cast<float>(i % 3),
                bz = h - 0.105F - 0.028F * static_cast<float>(i / 3);
    m.box(metal, {bx, y - 0.002F, bz}, {bx + 0.02F, y + 0.003F, bz + 0.016F}, {.bevel_m = 0.001F});
  }
  handle(p, metal, {x - 0.142F, y, 0.05F}, {x - 0.142F, y, h - 0.04F}, 0.026F);
}

void toaster(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("ceramic", {176, 58, 48}, 0.3, 61));
  const MaterialId black = p.fixed(knob_plastic());
  MeshBuilder& m = p.mesh;
  m.cushion(body, {-0.01F, 0, 0.5F * h + 0.006F}, {w - 0.04F, d - 0.01F, h - 0.012F}, 0.035F, 0.0F,
            0.06F);
  m.box(black, {-w / 2 + 0.02F, -d / 2 + 0.02F, 0}, {w / 2 - 0.04F, d / 2 - 0.02F, 0.02F});
  for (const float y : {-0.032F, 0.032F})
    m.box(black, {-w / 2 + 0.05F, y - 0.014F, h - 0.01F}, {w / 2 - 0.07F, y + 0.014F, h + 0.0F},
          {.bevel_m = 0.001F});
  m.box(black, {w / 2 - 0.032F, -0.02F, 0.6F * h}, {w / 2 - 0.005F, 0.02F, 0.6F * h + 0.022F});
}

void kettle(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("brushed_metal", {190, 192, 194}, 0.4, 62));
  const MaterialId black = p.fixed(knob_plastic());
  MeshBuilder& m = p.mesh;
  const float r = 0.48F * d, top = 0.78F * h;
  const std::array<Vector2f, 9> profile = {{{0.001F, 0},
                                            {0.9F * r, 0},
                                            {r, 0.02F},
                                            {0.95F * r, 0.3F * top},
                                            {0.78F * r, 0.7F * top},
                                            {0.62F * r, 0.93F * top},
                                            {0.55F * r, top},
                                            {0.2F * r, 1.07F * top},
                                            {0.001F, 1.08F * top}}};
  const float cx = -0.02F;
  m.lathe(body, {cx, 0, 0}, profile, 22);
  m.lathe(
      black, {cx, 0, 1.075F * top},
      std::array<Vector2f, 4>{{{0.001F, 0}, {0.012F, 0.0F}, {0.016F, 0.018F}, {0.001F, 0.024F}}},
      10);
  const std::array<Vector3f, 4> spout = {{{cx + 0.75F * r, 0, 0.45F * top},
                                          {cx + 1.1F * r, 0, 0.62F * top},
                                          {cx + 1.3F * r, 0, 0.86F * top},
                                          {cx + 1.42F * r, 0, 0.92F * top}}};
  m.tube(body, spout, std::array<float, 4>{0.024F, 0.018F, 0.014F, 0.012F}, 10);
  std::vector<Vector3f> grip;
  for (int i = 0; i <= 8; ++i) {
    const float a = 3.14159265F * static_cast<float>(i) / 8.0F;
    grip.emplace_back(cx + 0.62F * r * std::cos(a), 0,
                      0.86F * top + 0.36F * top * std::sin(a) * h / 0.24F);
  }
  m.tube(black, grip, 0.008F, 8);
  (void)w;
}

void pan(Piece& p) {
  const float d = p.size_m.y(), h = p.size_m.z(), w = p.size_m.x();
  const MaterialId body = p.material("body", plain("brushed_metal", {62, 62, 66}, 0.3, 63));
  const MaterialId black = p.fixed(knob_plastic());
  const float r = d / 2, cx = -w / 2 + r, z = 0.018F;
  const std::array<Vector2f, 6> profile = {{{0.001F, z},
                                            {0.85F * r, z},
                                            {r, h},
                                            {0.98F * r, h},
                                            {0.83F * r, z + 0.004F},
                                            {0.001F, z + 0.004F}}};
  p.mesh.lathe(body, {cx, 0, 0}, profile, 24);
  p.mesh.beam(black, {cx + 0.95F * r, 0, h - 0.02F}, {w / 2, 0, h - 0.005F}, 0.012F, 0.022F,
              {0, 0, 1});
}

}  // namespace mh::build
