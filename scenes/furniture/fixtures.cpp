// SPDX-License-Identifier: Apache-2.0
// Things fixed to walls: pipes, sockets, rails, signs, splash-backs.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

constexpr float kHalfPi = 1.57079633F;

MaterialSpec white_plastic() {
  return plain("plastic", {230, 230, 226}, 0.1, 161);
}
MaterialSpec outlet_plastic() {
  return plain("plastic", {34, 34, 38}, 0.2, 162);
}
MaterialSpec chrome() {
  return plain("brushed_metal", {192, 194, 198}, 0.2, 163);
}

/// The face of a power outlet, its middle at `at`, facing -y.
void outlet(Piece& p, MaterialId face, MaterialId dark, const Vector3f& at, float half) {
  MeshBuilder& m = p.mesh;
  m.box(face, at + Vector3f(-half, -0.008F, -half), at + Vector3f(half, 0.0F, half),
        {.bevel_m = 0.003F});
  const auto round = [&](MaterialId material, float x, float z, float radius, float out) {
    m.cylinder(material, at + Vector3f(x, -0.004F, z), at + Vector3f(x, -out, z), {radius, radius},
               14);
  };
  round(dark, 0, 0, 0.60F * half, 0.0084F);
  round(face, 0, 0, 0.54F * half, 0.0087F);
  for (const float s : {-1.0F, 1.0F}) round(dark, s * 0.28F * half, 0, 0.10F * half, 0.0091F);
}

}  // namespace

void socket(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId face = p.material("body", white_plastic()), dark = p.fixed(outlet_plastic());
  const float half = 0.25F * w, z = h - half - 0.004F;
  for (const float s : {-1.0F, 1.0F}) outlet(p, face, dark, {s * half, d / 2, z}, half - 0.001F);
  if (p.random.uniform(0) < 0.4) return;
  // A plug whose cable hangs down to the floor.
  const MaterialId cable = p.random.uniform(1) < 0.5 ? dark : face;
  const float y = d / 2 - 0.009F;
  p.mesh.cylinder(cable, {half, y, z}, {half, y - 0.03F, z}, {0.017F, 0.014F}, 12);
  const std::array<Vector3f, 6> way = {{{half, y - 0.03F, z},
                                        {half, y - 0.035F, z - 0.03F},
                                        {half - 0.01F, y - 0.02F, 0.6F * z},
                                        {half - 0.02F, y - 0.015F, 0.3F * z},
                                        {half - 0.05F, y - 0.02F, 0.04F},
                                        {-0.9F * half, y - 0.025F, 0.006F}}};
  p.mesh.tube(cable, way, 0.005F, 8);
}

void trunking(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", white_plastic()), dark = p.fixed(outlet_plastic());
  MeshBuilder& m = p.mesh;
  const float front = -d / 2 + 0.012F;
  m.box(body, {-w / 2, front, 0}, {w / 2, d / 2, h}, {.bevel_m = 0.003F});
  for (const float z : {0.16F * h, 0.82F * h})  // the joints of its lid
    m.box(dark, {-w / 2 + 0.002F, front - 0.001F, z}, {w / 2 - 0.002F, front + 0.001F, z + 0.003F},
          {.bevel_m = 0.0F});
  const int outlets = std::max(1, static_cast<int>(w / 0.55F));
  for (int i = 0; i < outlets; ++i) {
    const float x = -w / 2 + (static_cast<float>(i) + 0.5F) * w / static_cast<float>(outlets);
    for (const float s : {-1.0F, 1.0F})
      outlet(p, body, dark, {x + s * 0.045F, front, 0.5F * h}, std::min(0.04F, 0.30F * h));
  }
}

void dado_rail(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak());
  const std::array<std::array<float, 3>, 3> steps = {{{0.0F, 0.28F, 0.5F},  // from, to, out
                                                      {0.30F, 0.72F, 1.0F},
                                                      {0.74F, 1.0F, 0.6F}}};
  for (const auto& [low, high, out] : steps)
    p.mesh.box(wood, {-w / 2, d / 2 - out * d, low * h}, {w / 2, d / 2, high * h},
               {.bevel_m = 0.002F, .grain_axis = 0});
}

void pipes(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId pipe = p.material("metal", plain("brushed_metal", {184, 130, 90}, 0.3, 164));
  const MaterialId clamp = p.fixed(chrome());
  const MaterialId valve = p.fixed(plain("plastic", {176, 44, 40}, 0.1, 165));
  MeshBuilder& m = p.mesh;
  const float r = std::min(0.014F, 0.28F * d), y = d / 2 - 1.6F * r - 0.006F;
  // Two pipes rise at the left; near the floor they turn and run along the wall.
  for (int i = 0; i < 2; ++i) {
    const float x = -w / 2 + 0.03F + 0.07F * static_cast<float>(i),
                z = 0.05F + 0.07F * static_cast<float>(i);
    const bool turns = w > 0.35F;
    m.cylinder(pipe, {x, y, turns ? z : 0.0F}, {x, y, h}, {r, r}, 12);
    if (turns) {
      m.cylinder(pipe, {x, y, z}, {w / 2, y, z}, {r, r}, 12);
      m.cylinder(clamp, {x, y, z - 1.7F * r}, {x, y, z + 1.9F * r}, {1.35F * r, 1.35F * r}, 12);
    }
    for (float at = z + 0.3F; at < h - 0.05F; at += 0.45F)
      m.box(clamp, {x - 1.4F * r, y - 1.4F * r, at}, {x + 1.4F * r, d / 2, at + 0.02F},
            {.bevel_m = 0.002F});
    for (float at = x + 0.3F; turns && at < w / 2 - 0.05F; at += 0.45F)
      m.box(clamp, {at, y - 1.4F * r, z - 1.4F * r}, {at + 0.02F, d / 2, z + 1.4F * r},
            {.bevel_m = 0.002F});
  }
  const float x = -w / 2 + 0.03F, z = std::min(0.55F * h, 0.75F);
  m.cylinder(clamp, {x, y, z - 0.035F}, {x, y, z + 0.035F}, {1.6F * r, 1.6F * r}, 12);
  m.cylinder(clamp, {x, y - r, z}, {x, -d / 2 + 0.012F, z}, {0.6F * r, 0.6F * r}, 8);
  m.cylinder(valve, {x, -d / 2 + 0.014F, z}, {x, -d / 2 + 0.002F, z}, {0.028F, 0.028F}, 14);
}

void towel_radiator(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId metal = p.material("body", white_plastic());
  MeshBuilder& m = p.mesh;
  const float x = w / 2 - 0.018F, y = 0.05F * d;
  for (const float s : {-1.0F, 1.0F}) {
    m.cylinder(metal, {s * x, y, 0}, {s * x, y, h}, {0.016F, 0.016F}, 12);
    for (const float z : {0.1F * h, 0.9F * h})
      m.cylinder(metal, {s * x, y, z}, {s * x, d / 2, z}, {0.010F, 0.014F}, 8);
  }
  float rail = 0;
  int since_gap = 0;
  for (float z = 0.04F; z < h - 0.03F; z += since_gap == 5 ? 0.12F : 0.048F) {
    since_gap = since_gap == 5 ? 0 : since_gap + 1;
    m.cylinder(metal, {-x, y, z}, {x, y, z}, {0.011F, 0.011F}, 10);
    if (z < 0.78F * h) rail = z;
  }
  p.part("towel", "towel");
  const MaterialId cloth = p.material("fabric", plain("fabric", {132, 152, 178}, 0.5, 166));
  const float half = 0.36F * w, length = 0.5F * h, side = 0.08F * w;
  m.sheet(cloth,
          [&](float s, float t) -> Vector3f {  // over the rail, the longer flap in front
            const float along = (t - 0.4F) * 1.6F * length;
            const float fall = std::max(0.0F, std::abs(along) - 0.02F);
            const float out = std::clamp(along / 0.02F, -1.0F, 1.0F);
            const float ripple = 0.005F * std::sin(8.0F * s) * std::min(1.0F, fall / 0.1F);
            return {side + (2.0F * s - 1.0F) * half, y - 0.016F * out - ripple,
                    rail + 0.014F * (1.0F - out * out) - fall};
          },
          12, 30, {2 * half, 1.6F * length});
  p.body();
}

void tile_panel(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId tiles = p.material("tiles", plain("tiles", {206, 214, 216}, 0.4, 167));
  const MaterialId edge = p.fixed(chrome());
  p.mesh.box(tiles, {-w / 2 + 0.004F, -d / 2 + 0.001F, 0}, {w / 2 - 0.004F, d / 2, h - 0.006F},
             {.bevel_m = 0.0F});
  p.mesh.box(edge, {-w / 2, -d / 2, h - 0.0058F}, {w / 2, d / 2, h}, {.bevel_m = 0.0F});
  for (const float s : {-1.0F, 1.0F})
    p.mesh.box(edge, {s > 0 ? w / 2 - 0.0038F : -w / 2, -d / 2, 0},
               {s > 0 ? w / 2 : -w / 2 + 0.0038F, d / 2, h - 0.006F}, {.bevel_m = 0.0F});
}

void fuse_box(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("plastic", {206, 206, 200}, 0.1, 168));
  const MaterialId dark = p.fixed(outlet_plastic()), metal = p.fixed(chrome());
  MeshBuilder& m = p.mesh;
  const float y = -d / 2 + 0.02F;
  m.box(body, {-w / 2, y, 0}, {w / 2, d / 2, h}, {.bevel_m = 0.004F});
  m.box(body, {-w / 2 + 0.012F, y - 0.012F, 0.012F}, {w / 2 - 0.012F, y - 0.0005F, h - 0.012F},
        {.bevel_m = 0.003F});
  // A row of switches behind a pane, a label below, a lock.
  const float wide = w - 0.09F, z = 0.66F * h;
  m.box(dark, {-wide / 2, y - 0.014F, z}, {wide / 2, y - 0.0122F, z + 0.11F}, {.bevel_m = 0.0F});
  const int n = std::max(4, static_cast<int>(wide / 0.026F));
  for (int i = 0; i < n; ++i) {
    const float x =
        -wide / 2 + 0.004F + (wide - 0.008F) * static_cast<float>(i) / static_cast<float>(n);
    m.box(body, {x + 0.003F, y - 0.016F, z + 0.012F},
          {x + (wide - 0.008F) / static_cast<float>(n) - 0.002F, y - 0.0142F, z + 0.098F},
          {.bevel_m = 0.0F});
    const float up = p.random.uniform(static_cast<std::uint64_t>(i)) < 0.85 ? 0.055F : 0.03F;
    m.box(dark, {x + 0.007F, y - 0.02F, z + up},
          {x + (wide - 0.008F) / static_cast<float>(n) - 0.006F, y - 0.0162F, z + up + 0.02F},
          {.bevel_m = 0.0F});
  }
  MaterialSpec label = plain("paper", {238, 234, 220}, 0.6, 169 + p.random.below(90, 900));
  label.size_m = {0.6F * wide, 0.36F * h};
  m.image(p.fixed(label), {-0.3F * wide, y - 0.0125F, 0.54F * h}, {0.6F * wide, 0, 0},
          {0, 0, -0.36F * h});
  m.cylinder(metal, {0.42F * wide, y - 0.011F, 0.3F * h}, {0.42F * wide, y - 0.018F, 0.3F * h},
             {0.014F, 0.014F}, 14);
}

void sign(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  constexpr std::array<Rgb8, 4> kTones = {
      {{20, 120, 70}, {30, 84, 150}, {190, 44, 40}, {226, 180, 40}}};
  const auto form = p.random.below(0, 4);
  const MaterialId field = p.fixed(plain("plastic", kTones[form], 0.1, 170));
  const MaterialId white = p.fixed(plain("plastic", {240, 240, 236}, 0.05, 171));
  MeshBuilder& m = p.mesh;
  m.box(white, {-w / 2, -d / 2 + 0.003F, 0}, {w / 2, d / 2, h}, {.bevel_m = 0.001F});
  const float rim = 0.03F * w + 0.003F;
  m.box(field, {-w / 2 + rim, -d / 2 + 0.0015F, rim}, {w / 2 - rim, -d / 2 + 0.0028F, h - rim},
        {.bevel_m = 0.0F});
  // An arrow, a doorway or a bar with an outline, lines of writing beside it.
  m.push(translation(0, -d / 2 + 0.0014F, 0) * turn(Vector3f::UnitX(), kHalfPi));  // z is -y now
  const float u = 0.5F * h - rim, cx = -w / 2 + rim + u, cy = 0.5F * h, e = 0.0012F;
  if (form == 0) {
    const std::array<Vector2f, 3> head = {
        {{cx, cy - 0.62F * u}, {cx + 0.75F * u, cy}, {cx, cy + 0.62F * u}}};
    m.prism(white, head, 0, e);
    m.box(white, {cx - 0.7F * u, cy - 0.22F * u, 0}, {cx - 0.001F, cy + 0.22F * u, e},
          {.bevel_m = 0.0F});
  } else if (form == 1) {
    for (const float s : {-1.0F, 1.0F})
      m.box(white, {cx + s * 0.5F * u - 0.08F * u, cy - 0.7F * u, 0},
            {cx + s * 0.5F * u + 0.08F * u, cy + 0.7F * u, e}, {.bevel_m = 0.0F});
    m.box(white, {cx - 0.25F * u, cy - 0.5F * u, 0}, {cx + 0.25F * u, cy + 0.3F * u, e},
          {.bevel_m = 0.0F});
  } else {
    const std::array<Vector2f, 3> up = {
        {{cx - 0.75F * u, cy - 0.6F * u}, {cx + 0.75F * u, cy - 0.6F * u}, {cx, cy + 0.75F * u}}};
    m.prism(white, up, 0, e);
    m.box(field, {cx - 0.07F * u, cy - 0.25F * u, e + 0.0001F},
          {cx + 0.07F * u, cy + 0.3F * u, e + 0.0002F}, {.bevel_m = 0.0F});
  }
  const float x0 = cx + 1.05F * u, x1 = w / 2 - 2 * rim;
  for (int i = 0; i < 3 && x1 > x0 + 0.02F; ++i) {
    const float z = cy + 0.45F * u - 0.5F * u * static_cast<float>(i);
    const auto end =
        static_cast<float>(p.random.uniform(static_cast<std::uint64_t>(10 + i), 0.6, 1.0));
    m.box(white, {x0, z - 0.10F * u, 0}, {x0 + end * (x1 - x0), z + 0.10F * u, e},
          {.bevel_m = 0.0F});
  }
  m.pop();
}

void calendar(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId paper = p.fixed(plain("plaster", {238, 236, 230}, 0.1, 172));
  const MaterialId ink = p.fixed(outlet_plastic());
  const MaterialId red = p.fixed(plain("plastic", {180, 44, 40}, 0.1, 173));
  MeshBuilder& m = p.mesh;
  m.box(paper, {-w / 2, -d / 2 + 0.002F, 0}, {w / 2, d / 2, h}, {.bevel_m = 0.0F});
  MaterialSpec view = plain("painting", {120, 130, 140}, 0.8, 174 + p.random.below(0, 5000));
  view.size_m = {0.92F * w, 0.46F * h};
  const float y = -d / 2 + 0.0015F;
  m.image(p.fixed(view), {-0.46F * w, y, 0.97F * h}, {0.92F * w, 0, 0}, {0, 0, -0.46F * h});
  const auto mark = [&](MaterialId material, float x, float z, float wide, float tall) {
    m.box(material, {x, y - 0.0004F, z}, {x + wide, y + 0.0004F, z + tall}, {.bevel_m = 0.0F});
  };
  mark(ink, -0.44F * w, 0.44F * h, 0.4F * w, 0.035F * h);
  for (int i = 0; i < 5; ++i)
    for (int k = 0; k < 7; ++k) {
      const float x = -0.45F * w + 0.13F * w * static_cast<float>(k),
                  z = 0.35F * h - 0.075F * h * static_cast<float>(i);
      mark(k == 6 ? red : ink, x + 0.03F * w, z, 0.05F * w, 0.03F * h);
    }
  for (int i = 0; i < 6; ++i)
    mark(ink, -0.46F * w, 0.04F * h + 0.075F * h * static_cast<float>(i), 0.92F * w, 0.0015F);
}

void bath_shelf(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId board = p.material("wood", oak()), metal = p.fixed(chrome());
  const MaterialId cloth = p.material("fabric", plain("fabric", {150, 170, 150}, 0.5, 175));
  MeshBuilder& m = p.mesh;
  constexpr std::array<Rgb8, 6> kTones = {{{236, 234, 226},
                                           {64, 118, 150},
                                           {196, 96, 84},
                                           {226, 190, 90},
                                           {70, 110, 84},
                                           {60, 60, 66}}};
  const std::array<float, 2> levels = {0.02F, 0.55F * h};
  for (const float s : {-1.0F, 1.0F})
    m.box(metal, {s * (w / 2 - 0.01F) - 0.008F, d / 2 - 0.015F, 0},
          {s * (w / 2 - 0.01F) + 0.008F, d / 2, h}, {.bevel_m = 0.002F});
  std::uint64_t key = 0;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const float z = levels[k], top = (k == 0 ? levels[1] : h) - z - 0.03F;
    m.box(board, {-w / 2, -d / 2, z}, {w / 2, d / 2 - 0.0155F, z + 0.015F}, {.grain_axis = 0});
    float x = -w / 2 + 0.03F;
    while (x < w / 2 - 0.05F) {
      const RandomStream r = p.random.fork(++key);
      const MaterialId stuff =
          p.fixed(plain("plastic", kTones[r.below(0, kTones.size())], 0.15, 176));
      const auto tall = top * static_cast<float>(r.uniform(1, 0.45, 0.95));
      const double what = r.uniform(2);
      const float left = w / 2 - 0.02F - x;
      if (what < 0.25 && left > 0.24F) {  // folded towels
        const float each = std::min(0.045F, 0.3F * top);
        for (int i = 0; i < 3; ++i)
          m.cushion(cloth, {x + 0.11F, 0, z + 0.016F + each * (static_cast<float>(i) + 0.5F)},
                    {0.21F, 0.8F * d, each - 0.002F}, 0.4F * each, 0.0F, 0.06F);
        x += 0.24F;
      } else if (what < 0.75) {  // bottles and tubes
        const auto radius = std::min(0.35F * d, static_cast<float>(r.uniform(3, 0.018, 0.032)));
        const MaterialId cap =
            p.fixed(plain("plastic", kTones[r.below(4, kTones.size())], 0.1, 177));
        m.cylinder(stuff, {x + radius, 0, z + 0.0155F}, {x + radius, 0, z + 0.0155F + 0.78F * tall},
                   {radius, 0.95F * radius}, 14);
        m.cylinder(cap, {x + radius, 0, z + 0.0155F + 0.78F * tall},
                   {x + radius, 0, z + 0.0155F + tall}, {0.5F * radius, 0.45F * radius}, 10);
        x += 2 * radius + static_cast<float>(r.uniform(5, 0.008, 0.05));
      } else {
        const auto wide = std::min(left, static_cast<float>(r.uniform(3, 0.05, 0.13)));
        m.box(stuff, {x, -0.35F * d, z + 0.0155F}, {x + wide, 0.3F * d, z + 0.0155F + 0.7F * tall},
              {.bevel_m = 0.004F});
        x += wide + static_cast<float>(r.uniform(5, 0.01, 0.05));
      }
    }
  }
}

void broom_rack(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId board = p.material("wood", oak()), metal = p.fixed(chrome());
  const MaterialId stick = p.fixed(plain("wood_grain", {196, 158, 110}, 0.3, 178));
  constexpr std::array<Rgb8, 4> kTones = {
      {{176, 48, 42}, {48, 90, 140}, {60, 110, 70}, {220, 176, 60}}};
  MeshBuilder& m = p.mesh;
  m.box(board, {-w / 2, d / 2 - 0.02F, h - 0.12F}, {w / 2, d / 2, h - 0.04F}, {.grain_axis = 0});
  const int n = std::max(2, static_cast<int>(w / 0.2F));
  for (int i = 0; i < n; ++i) {
    const RandomStream r = p.random.fork(static_cast<std::uint64_t>(i));
    const float x = -w / 2 + (static_cast<float>(i) + 0.5F) * w / static_cast<float>(n);
    const float y = d / 2 - 0.045F, foot = h * static_cast<float>(r.uniform(0, 0.0, 0.12));
    const float half = std::min(0.14F, 0.42F * w / static_cast<float>(n));
    const MaterialId tone = p.fixed(plain("plastic", kTones[r.below(1, kTones.size())], 0.2, 179));
    m.box(metal, {x - 0.02F, y - 0.02F, h - 0.09F}, {x + 0.02F, d / 2 - 0.0205F, h - 0.07F},
          {.bevel_m = 0.002F});
    m.cylinder(r.uniform(2) < 0.6 ? stick : metal, {x, y, foot + 0.1F}, {x, y, h}, {0.011F, 0.011F},
               10);
    switch (r.below(3, 4)) {
      case 0:  // a broom
        m.box(tone, {x - half, y - 0.02F, foot + 0.08F}, {x + half, y + 0.02F, foot + 0.115F},
              {.bevel_m = 0.006F});
        for (int k = 0; k < 9; ++k) {
          const float bx = x + half * (-0.92F + 0.23F * static_cast<float>(k));
          m.box(k % 2 ? tone : stick, {bx - 0.09F * half, y - 0.018F, foot + 0.005F},
                {bx + 0.09F * half, y + 0.018F, foot + 0.0795F}, {.bevel_m = 0.0F});
        }
        break;
      case 1:  // a mop
        m.cylinder(tone, {x, y, foot + 0.2F}, {x, y, foot + 0.28F}, {0.02F, 0.014F}, 10);
        for (int k = 0; k < 9; ++k) {
          const float a = 0.698F * static_cast<float>(k);
          const std::array<Vector3f, 3> strand = {
              {{x, y, foot + 0.21F},
               {x + 0.55F * half * std::cos(a), y + 0.018F * std::sin(a), foot + 0.15F},
               {x + 0.7F * half * std::cos(a), y + 0.022F * std::sin(a), foot + 0.01F}}};
          m.tube(p.fixed(plain("knit", {214, 208, 196}, 0.4, 180)), strand, 0.010F, 6);
        }
        break;
      case 2:  // a spade
        m.box(metal, {x - 0.75F * half, y - 0.006F, foot + 0.01F},
              {x + 0.75F * half, y + 0.006F, foot + 0.24F}, {.bevel_m = 0.004F});
        break;
      default:  // a squeegee with a colored handle
        m.box(tone, {x - half, y - 0.012F, foot + 0.07F}, {x + half, y + 0.012F, foot + 0.10F},
              {.bevel_m = 0.003F});
        m.box(metal, {x - 0.96F * half, y - 0.003F, foot + 0.03F},
              {x + 0.96F * half, y + 0.003F, foot + 0.0695F}, {.bevel_m = 0.0F});
        m.cylinder(tone, {x, y, 0.72F * h}, {x, y, h}, {0.015F, 0.015F}, 10);
    }
  }
}

}  // namespace mh::build
