// SPDX-License-Identifier: Apache-2.0
// Things in game and music rooms.
#include <array>
#include <cmath>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector2f;
using Eigen::Vector3f;

void pool_table(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", plain("wood_grain", {104, 66, 42}, 0.5, 193));
  const MaterialId cloth = p.material("fabric", plain("fabric", {38, 112, 70}, 0.2, 194)),
                   black = p.fixed(black_rubber());
  MeshBuilder& m = p.mesh;
  const float rim = 0.13F, bed = h - 0.05F;
  m.max_edge_m = 0.08F;
  m.box(cloth, {-w / 2 + rim, -d / 2 + rim, bed - 0.03F}, {w / 2 - rim, d / 2 - rim, bed},
        {.bevel_m = 0.0F});
  m.max_edge_m = 0.12F;
  for (const float s : {-1.0F, 1.0F}) {
    m.box(wood, {-w / 2, s > 0 ? d / 2 - rim : -d / 2, bed - 0.14F},
          {w / 2, s > 0 ? d / 2 : -d / 2 + rim, h}, {.bevel_m = 0.015F, .grain_axis = 0});
    m.box(wood, {s > 0 ? w / 2 - rim : -w / 2, -d / 2 + rim, bed - 0.14F},
          {s > 0 ? w / 2 : -w / 2 + rim, d / 2 - rim, h}, {.bevel_m = 0.015F, .grain_axis = 1});
    m.box(cloth, {-w / 2 + rim, s > 0 ? d / 2 - rim - 0.04F : -d / 2 + rim, bed},
          {w / 2 - rim, s > 0 ? d / 2 - rim : -d / 2 + rim + 0.04F, h - 0.006F},
          {.bevel_m = 0.01F});
    m.box(cloth, {s > 0 ? w / 2 - rim - 0.04F : -w / 2 + rim, -d / 2 + rim + 0.04F, bed},
          {s > 0 ? w / 2 - rim : -w / 2 + rim + 0.04F, d / 2 - rim - 0.04F, h - 0.006F},
          {.bevel_m = 0.01F});
    for (const float x : {-w / 2 + 0.8F * rim, 0.0F, w / 2 - 0.8F * rim})
      m.cylinder(black, {x, s * (d / 2 - 0.75F * rim), h - 0.02F},
                 {x, s * (d / 2 - 0.75F * rim), h + 0.0F}, {0.055F, 0.055F}, 18);
    for (const float sx : {-1.0F, 1.0F})
      m.cylinder(wood, {sx * (w / 2 - 0.28F), s * (d / 2 - 0.28F), 0},
                 {sx * (w / 2 - 0.28F), s * (d / 2 - 0.28F), bed - 0.14F}, {0.05F, 0.085F}, 16);
  }
  m.box(wood, {-w / 2 + 0.15F, -d / 2 + 0.15F, bed - 0.20F},
        {w / 2 - 0.15F, d / 2 - 0.15F, bed - 0.031F});
  constexpr std::array<Rgb8, 8> kBalls = {{{226, 190, 40},
                                           {40, 60, 150},
                                           {190, 40, 36},
                                           {90, 50, 120},
                                           {220, 110, 40},
                                           {30, 100, 60},
                                           {120, 40, 36},
                                           {236, 234, 226}}};
  p.part("balls", "otherprop");
  for (std::uint64_t i = 0; i < 12; ++i) {
    const RandomStream r = p.random.fork(i);
    const Vector2f at(static_cast<float>(r.uniform(0, -0.5, 0.5)) * (w - 2 * rim - 0.2F),
                      static_cast<float>(r.uniform(1, -0.5, 0.5)) * (d - 2 * rim - 0.2F));
    m.cushion(p.fixed(plain("ceramic", kBalls[i % 8], 0.1)), {at.x(), at.y(), bed + 0.029F},
              {0.057F, 0.057F, 0.057F}, 0.028F, 0.0F, 0.02F);
  }
  p.body();
}

void fireplace(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId stone = p.material("top", plain("stone", {196, 192, 184}, 0.3, 211)),
                   soot = p.fixed(plain("plaster", {34, 31, 29}, 0.8, 212));
  const MaterialId log = p.fixed(plain("bark", {96, 70, 50}, 0.8, 213));
  MeshBuilder& m = p.mesh;
  const float jamb = 0.24F * w, open = 0.72F * h;
  for (const float s : {-1.0F, 1.0F})
    m.box(stone, {s > 0 ? w / 2 - jamb : -w / 2 + 0.03F, -d / 2 + 0.06F, 0.05F},
          {s > 0 ? w / 2 - 0.03F : -w / 2 + jamb, d / 2, open}, {.bevel_m = 0.008F});
  m.box(stone, {-w / 2, -d / 2, 0}, {w / 2, d / 2, 0.05F}, {.bevel_m = 0.008F});
  m.box(stone, {-w / 2 + 0.03F, -d / 2 + 0.06F, open + 0.001F}, {w / 2 - 0.03F, d / 2, h - 0.06F},
        {.bevel_m = 0.008F});
  m.box(stone, {-w / 2, -d / 2 + 0.01F, h - 0.059F}, {w / 2, d / 2, h}, {.bevel_m = 0.012F});
  m.box(soot, {-w / 2 + jamb, d / 2 - 0.04F, 0.05F}, {w / 2 - jamb, d / 2 - 0.002F, open},
        {.bevel_m = 0.0F});
  for (int i = 0; i < 4; ++i) {
    const float x = 0.11F * (static_cast<float>(i) - 1.5F);
    m.cylinder(log,
               {x - 0.16F, -0.02F + 0.03F * static_cast<float>(i % 2),
                0.10F + 0.05F * static_cast<float>(i % 2)},
               {x + 0.18F, 0.03F, 0.11F + 0.06F * static_cast<float>((i + 1) % 2)}, {0.045F, 0.04F},
               12);
  }
}

void piano(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", plain("wood_grain", {60, 40, 30}, 0.3, 214)),
                   white = p.fixed(plain("ceramic", {236, 234, 224}, 0.05, 215)),
                   black = p.fixed(black_rubber());
  MeshBuilder& m = p.mesh;
  const float deep = 0.56F * d, keys = 0.64F;
  m.box(wood, {-w / 2, d / 2 - deep, 0}, {w / 2, d / 2, h - 0.03F},
        {.bevel_m = 0.006F, .grain_axis = 0});
  m.box(wood, {-w / 2 - 0.0F, d / 2 - deep - 0.02F, h - 0.029F}, {w / 2, d / 2, h},
        {.bevel_m = 0.006F, .grain_axis = 0});
  m.box(wood, {-w / 2, -d / 2, keys - 0.08F}, {w / 2, d / 2 - deep - 0.001F, keys},
        {.bevel_m = 0.006F, .grain_axis = 0});
  for (const float s : {-1.0F, 1.0F}) {
    m.box(wood, {s > 0 ? w / 2 - 0.05F : -w / 2, -d / 2, keys},
          {s > 0 ? w / 2 : -w / 2 + 0.05F, d / 2 - deep - 0.001F, keys + 0.10F});
    m.box(wood, {s * (w / 2 - 0.05F) - 0.035F, -d / 2 + 0.03F, 0},
          {s * (w / 2 - 0.05F) + 0.035F, -d / 2 + 0.10F, keys - 0.081F}, {.grain_axis = 2});
  }
  const int n = 52;
  const float each = (w - 0.12F) / static_cast<float>(n), y1 = d / 2 - deep - 0.02F;
  for (int i = 0; i < n; ++i) {
    const float x = -w / 2 + 0.06F + each * static_cast<float>(i);
    m.box(white, {x + 0.0006F, y1 - 0.15F, keys}, {x + each - 0.0006F, y1, keys + 0.018F},
          {.bevel_m = 0.0F});
    const int note = i % 7;
    if (note != 2 && note != 6 && i + 1 < n)
      m.box(black, {x + 0.7F * each, y1 - 0.10F, keys + 0.018F},
            {x + 1.3F * each, y1, keys + 0.03F}, {.bevel_m = 0.0F});
  }
  MaterialSpec sheet = plain("paper", {236, 234, 226}, 0.7, 216);
  sheet.size_m = {0.42F, 0.28F};
  m.image(p.fixed(sheet), {-0.21F, d / 2 - deep - 0.012F, keys + 0.46F}, {0.42F, 0, 0},
          {0, 0.006F, -0.28F});
}

void stool(Piece& p) {
  const float w = p.size_m.x(), h = p.size_m.z();
  const MaterialId pad = p.material("fabric", plain("leather", {60, 44, 38}, 0.4, 217)),
                   metal = p.material("metal", bare_steel());
  MeshBuilder& m = p.mesh;
  const float r = w / 2;
  m.lathe(
      pad, {0, 0, h - 0.07F},
      std::array<Vector2f, 6>{
          {{0.001F, 0}, {0.9F * r, 0}, {r, 0.02F}, {r, 0.05F}, {0.9F * r, 0.07F}, {0.001F, 0.07F}}},
      24);
  for (int i = 0; i < 4; ++i) {
    const float a = 0.785F + 1.5708F * static_cast<float>(i);
    m.cylinder(metal, {0.95F * r * std::cos(a), 0.95F * r * std::sin(a), 0},
               {0.6F * r * std::cos(a), 0.6F * r * std::sin(a), h - 0.07F}, {0.012F, 0.012F}, 8);
  }
  std::vector<Vector3f> ring;
  for (int i = 0; i <= 24; ++i) {
    const float a = 6.2831853F * static_cast<float>(i % 24) / 24.0F;
    ring.emplace_back(0.8F * r * std::cos(a), 0.8F * r * std::sin(a), 0.35F * h);
  }
  m.tube(metal, ring, 0.009F, 8);
}

void dart_board(Piece& p) {
  const float r = 0.5F * p.size_m.x(), d = p.size_m.y();
  MeshBuilder& m = p.mesh;
  const MaterialId black = p.fixed(plain("carpet", {30, 30, 32}, 0.3, 218)),
                   cream = p.fixed(plain("carpet", {216, 200, 160}, 0.3, 219));
  const MaterialId red = p.fixed(plain("carpet", {176, 40, 36}, 0.2, 220)),
                   green = p.fixed(plain("carpet", {40, 110, 66}, 0.2, 221));
  m.push(translation(0, d / 2, r) * turn(Vector3f::UnitX(), 1.57079633F));
  m.cylinder(black, {0, 0, 0}, {0, 0, 0.8F * d}, {r, r}, 40);
  const auto ring = [&](float r0, float r1, float z, bool bright) {
    for (int i = 0; i < 20; ++i) {
      const float a0 = 0.314159F * (static_cast<float>(i) - 0.5F);
      const MaterialId stuff = bright ? (i % 2 ? red : green) : (i % 2 ? black : cream);
      m.sheet(stuff,
              [&](float s, float t) -> Vector3f {
                const float a = a0 + 0.314159F * s, q = r1 + (r0 - r1) * t;
                return {q * std::cos(a), q * std::sin(a), z};
              },
              4, 1, {0.1F, 0.1F});
    }
  };
  const float z = 0.8F * d + 0.001F;
  ring(0.07F * r, 0.44F * r, z, false);
  ring(0.44F * r, 0.48F * r, z, true);
  ring(0.48F * r, 0.72F * r, z, false);
  ring(0.72F * r, 0.76F * r, z, true);
  m.cylinder(red, {0, 0, z - 0.001F}, {0, 0, d}, {0.06F * r, 0.06F * r}, 16);
  m.pop();
}

}  // namespace mh::build
