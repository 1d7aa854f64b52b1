// SPDX-License-Identifier: Apache-2.0
// Furniture of shops, schools, lobbies and corridors.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

MaterialSpec public_steel() {
  return plain("brushed_metal", {160, 163, 166}, 0.3, 171);
}
MaterialSpec rail_plastic() {
  return plain("plastic", {34, 35, 38}, 0.2, 172);
}

}  // namespace

void reception_desk(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak()),
                   top = p.material("top", plain("stone", {196, 192, 184}, 0.3, 173));
  const MaterialId metal = p.fixed(public_steel());
  MeshBuilder& m = p.mesh;
  const float work = 0.74F, front = 0.10F;
  m.box(metal, {-w / 2 + 0.03F, -d / 2 + 0.03F, 0}, {w / 2 - 0.03F, -d / 2 + front, 0.08F});
  const int panels = std::max(2, static_cast<int>(w / 0.6F));
  const float each = w / static_cast<float>(panels);
  for (int i = 0; i < panels; ++i)
    m.box(wood, {-w / 2 + each * static_cast<float>(i) + 0.003F, -d / 2, 0.081F},
          {-w / 2 + each * static_cast<float>(i + 1) - 0.003F, -d / 2 + front, h - 0.035F},
          {.grain_axis = 0});
  for (const float s : {-1.0F, 1.0F})
    m.box(wood, {s > 0 ? w / 2 - 0.04F : -w / 2, -d / 2 + front + 0.001F, 0},
          {s > 0 ? w / 2 : -w / 2 + 0.04F, d / 2, work - 0.03F}, {.grain_axis = 2});
  m.max_edge_m = 0.08F;
  m.box(wood, {-w / 2, -d / 2 + front + 0.001F, work - 0.029F}, {w / 2, d / 2, work},
        {.grain_axis = 0});
  m.box(top, {-w / 2, -d / 2, h - 0.034F}, {w / 2, -d / 2 + 0.34F, h}, {.bevel_m = 0.005F});
  m.max_edge_m = 0.12F;
  for (const float s : {-1.0F, 1.0F})
    m.box(metal, {s * (w / 2 - 0.1F) - 0.012F, -d / 2 + 0.28F, work},
          {s * (w / 2 - 0.1F) + 0.012F, -d / 2 + 0.30F, h - 0.035F});
}

void lift_door(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId metal = p.material("metal", public_steel()), black = p.fixed(rail_plastic());
  MeshBuilder& m = p.mesh;
  const float frame = 0.10F;
  for (const float s : {-1.0F, 1.0F}) {
    m.box(metal, {s > 0 ? w / 2 - frame : -w / 2, -d / 2, 0},
          {s > 0 ? w / 2 : -w / 2 + frame, d / 2, h - frame}, {.grain_axis = 2});
    const float a = s > 0 ? 0.003F : -w / 2 + frame + 0.002F,
                b = s > 0 ? w / 2 - frame - 0.002F : -0.003F;
    m.box(metal, {a, -d / 2 + 0.03F, 0.012F}, {b, d / 2 - 0.003F, h - frame - 0.004F},
          {.bevel_m = 0.002F, .grain_axis = 2});
  }
  m.box(metal, {-w / 2, -d / 2, h - frame}, {w / 2, d / 2, h}, {.grain_axis = 0});
  m.box(black, {-w / 2 + frame, -d / 2 + 0.02F, 0}, {w / 2 - frame, d / 2, 0.011F},
        {.bevel_m = 0.0F});
  m.box(black, {-0.09F, -d / 2 - 0.0F + 0.0005F, h - 0.075F}, {0.09F, -d / 2 + 0.004F, h - 0.025F},
        {.bevel_m = 0.0F});
  m.box(p.fixed(plain("plastic", {150, 60, 40}, 0.1), {0.6F, 0.12F, 0.05F}),
        {-0.018F, -d / 2, h - 0.066F}, {0.018F, -d / 2 + 0.003F, h - 0.034F}, {.bevel_m = 0.0F});
  const float x = w / 2 - 0.5F * frame;
  m.box(black, {x - 0.03F, -d / 2, 1.0F}, {x + 0.03F, -d / 2 + 0.006F, 1.18F}, {.bevel_m = 0.0F});
}

void magazine_rack(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak());
  MeshBuilder& m = p.mesh;
  for (const float s : {-1.0F, 1.0F})
    m.box(wood, {s > 0 ? w / 2 - 0.02F : -w / 2, -d / 2, 0},
          {s > 0 ? w / 2 : -w / 2 + 0.02F, d / 2, h}, {.grain_axis = 2});
  m.box(wood, {-w / 2 + 0.021F, d / 2 - 0.012F, 0.02F}, {w / 2 - 0.021F, d / 2, h - 0.01F},
        {.bevel_m = 0.0F});
  const int rows = std::max(3, static_cast<int>(h / 0.34F)),
            columns = std::max(2, static_cast<int>((w - 0.05F) / 0.25F));
  const float pitch = (h - 0.08F) / static_cast<float>(rows),
              each = (w - 0.05F) / static_cast<float>(columns);
  for (int j = 0; j < rows; ++j) {
    const float z = 0.05F + pitch * static_cast<float>(j);
    m.box(wood, {-w / 2 + 0.021F, -d / 2 + 0.01F, z}, {w / 2 - 0.021F, d / 2 - 0.013F, z + 0.015F},
          {.grain_axis = 0});
    m.box(wood, {-w / 2 + 0.021F, -d / 2 + 0.01F, z + 0.0155F},
          {w / 2 - 0.021F, -d / 2 + 0.02F, z + 0.05F}, {.grain_axis = 0});
    p.part(fmt::format("magazines_{}", j + 1), "books");
    for (int i = 0; i < columns; ++i) {
      const RandomStream r = p.random.fork(static_cast<std::uint64_t>(50 * j + i));
      if (r.uniform(0) < 0.12) continue;
      constexpr std::array<Rgb8, 6> kTones = {{{204, 60, 54},
                                               {60, 110, 160},
                                               {230, 190, 70},
                                               {90, 140, 100},
                                               {226, 222, 214},
                                               {60, 60, 70}}};
      const float mw = 0.21F, mh = std::min(0.28F, pitch - 0.04F),
                  x = -w / 2 + 0.025F + each * (static_cast<float>(i) + 0.5F);
      MaterialSpec cover =
          plain("book_covers", kTones[r.below(1, 6)], 0.8, 3000 + r.below(2, 5000));
      cover.size_m = {mw, mh};
      m.push(translation(x, -d / 2 + 0.03F, z + 0.016F) * turn(Vector3f::UnitX(), -0.30F));
      m.box(p.fixed(plain("plaster", {224, 220, 210}, 0.2, 9)), {-mw / 2, 0.0008F, 0},
            {mw / 2, 0.006F, mh}, {.bevel_m = 0.0F});
      m.image(p.fixed(cover), {-mw / 2, 0, mh}, {mw, 0, 0}, {0, 0, -mh});
      m.pop();
    }
    p.body();
  }
}

void school_desk(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId top = p.material("wood", oak()), metal = p.material("metal", public_steel());
  MeshBuilder& m = p.mesh;
  m.max_edge_m = 0.07F;
  m.box(top, {-w / 2, -d / 2, h - 0.022F}, {w / 2, d / 2, h}, {.bevel_m = 0.005F, .grain_axis = 0});
  m.max_edge_m = 0.12F;
  m.box(metal, {-0.42F * w, -0.38F * d, h - 0.13F}, {0.42F * w, 0.42F * d, h - 0.118F},
        {.bevel_m = 0.0F});  // book tray
  for (const float sx : {-1.0F, 1.0F}) {
    const float x = sx * (w / 2 - 0.04F);
    const std::array<Vector3f, 4> frame = {{{x, -0.44F * d, 0.012F},
                                            {x, -0.44F * d, h - 0.04F},
                                            {x, 0.42F * d, h - 0.04F},
                                            {x, 0.42F * d, 0.012F}}};
    m.tube(metal, frame, 0.013F, 8);
    m.cylinder(metal, {x, -0.44F * d, 0.18F}, {x, 0.42F * d, 0.18F}, {0.010F, 0.010F}, 8);
  }
  m.cylinder(metal, {-w / 2 + 0.04F, 0.42F * d, 0.18F}, {w / 2 - 0.04F, 0.42F * d, 0.18F},
             {0.010F, 0.010F}, 8);
}

void school_chair(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId shell = p.material("body", plain("plastic", {48, 84, 130}, 0.2, 174)),
                   metal = p.material("metal", public_steel());
  MeshBuilder& m = p.mesh;
  const float seat = 0.44F, x = w / 2 - 0.04F;
  for (const float s : {-1.0F, 1.0F}) {
    const std::array<Vector3f, 4> leg = {{{s * x, -d / 2 + 0.03F, 0},
                                          {s * (x - 0.02F), -d / 2 + 0.06F, seat - 0.02F},
                                          {s * (x - 0.02F), 0.30F * d, seat - 0.02F},
                                          {s * x, d / 2 - 0.02F, 0}}};
    m.tube(metal, leg, 0.011F, 8);
    m.cylinder(metal, {s * (x - 0.02F), 0.28F * d, seat - 0.03F},
               {s * (x - 0.04F), d / 2 - 0.03F, h - 0.18F}, {0.010F, 0.010F}, 8);
  }
  m.sheet(shell,
          [&](float s, float t) -> Vector3f {  // a seat with a rolled front edge
            const float u = 2.0F * s - 1.0F, v = 0.5F - t;
            return {
                0.46F * w * u, -v * 0.76F * d - 0.03F * d,
                seat + 0.02F * u * u - 0.05F * std::pow(std::max(0.0F, v - 0.25F) / 0.25F, 2.0F)};
          },
          10, 10, {w, d});
  m.sheet(shell,
          [&](float s, float t) -> Vector3f {  // back, curved around the sitter
            const float u = 2.0F * s - 1.0F;
            return {0.45F * w * u, d / 2 - 0.03F - 0.05F * u * u, h - t * 0.27F};
          },
          12, 6, {w, 0.3F});
}

void projector_screen(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId cloth = p.fixed(plain("ceramic", {240, 240, 238}, 0.05, 175)),
                   black = p.fixed(rail_plastic());
  const MaterialId body = p.material("body", plain("plastic", {226, 226, 222}, 0.1, 176));
  MeshBuilder& m = p.mesh;
  m.box(body, {-w / 2, -d / 2, h - 0.09F}, {w / 2, d / 2, h}, {.bevel_m = 0.012F});
  m.box(cloth, {-w / 2 + 0.05F, -0.004F, 0.03F}, {w / 2 - 0.05F, 0.004F, h - 0.091F},
        {.bevel_m = 0.0F});
  for (const float s : {-1.0F, 1.0F})
    m.box(black, {s > 0 ? w / 2 - 0.075F : -w / 2 + 0.05F, -0.0046F, 0.03F},
          {s > 0 ? w / 2 - 0.05F : -w / 2 + 0.075F, -0.0041F, h - 0.092F}, {.bevel_m = 0.0F});
  m.box(black, {-w / 2 + 0.05F, -0.012F, 0}, {w / 2 - 0.05F, 0.012F, 0.03F}, {.bevel_m = 0.004F});
}

void wall_screen(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId black = p.fixed(rail_plastic());
  MaterialSpec usual = plain("screen", {70, 110, 150}, 0.7, 177);
  usual.size_m = {w - 0.03F, h - 0.03F};
  const MaterialId screen = p.random.uniform(1) < 0.4
                                ? p.material("screen", usual, {0.10F, 0.12F, 0.14F})
                                : p.material("screen", plain("glass", {20, 22, 26}, 0.2, 178));
  p.mesh.box(black, {-w / 2, -d / 2, 0}, {w / 2, -d / 2 + 0.04F, h}, {.bevel_m = 0.004F});
  p.mesh.box(black, {-0.2F * w, -d / 2 + 0.041F, 0.3F * h}, {0.2F * w, d / 2, 0.7F * h},
             {.bevel_m = 0.0F});
  p.mesh.image(screen, {-w / 2 + 0.015F, -d / 2 - 0.0005F + 0.0F, h - 0.015F}, {w - 0.03F, 0, 0},
               {0, 0, -(h - 0.03F)});
}

void lockers(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("plastic", {96, 116, 140}, 0.2, 179)),
                   metal = p.fixed(public_steel()), black = p.fixed(rail_plastic());
  MeshBuilder& m = p.mesh;
  const float y = -d / 2 + 0.03F;
  m.box(black, {-w / 2 + 0.01F, y + 0.03F, 0}, {w / 2 - 0.01F, d / 2, 0.08F}, {.bevel_m = 0.0F});
  m.box(body, {-w / 2, y, 0.081F}, {w / 2, d / 2, h});
  const int n = std::max(2, static_cast<int>(std::lround(w / 0.31F)));
  const int tiers = p.random.uniform(1) < 0.5 ? 1 : 2;
  const float each = w / static_cast<float>(n), tall = (h - 0.10F) / static_cast<float>(tiers);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < tiers; ++j) {
      const float a = -w / 2 + each * static_cast<float>(i) + 0.004F, b = a + each - 0.008F,
                  z0 = 0.09F + tall * static_cast<float>(j), z1 = z0 + tall - 0.01F;
      m.box(body, {a, y - 0.016F, z0}, {b, y - 0.0005F, z1}, {.bevel_m = 0.003F});
      for (int k = 0; k < 4; ++k)  // vents
        m.box(black, {a + 0.25F * each, y - 0.0168F, z1 - 0.07F - 0.03F * static_cast<float>(k)},
              {b - 0.25F * each, y - 0.0155F, z1 - 0.062F - 0.03F * static_cast<float>(k)},
              {.bevel_m = 0.0F});
      m.box(metal, {b - 0.05F, y - 0.026F, 0.5F * (z0 + z1) - 0.03F},
            {b - 0.03F, y - 0.0165F, 0.5F * (z0 + z1) + 0.05F});
    }
}

void fire_extinguisher(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId red = p.fixed(plain("ceramic", {186, 30, 28}, 0.1, 180)),
                   black = p.fixed(rail_plastic());
  MaterialSpec label = plain("paper", {236, 234, 226}, 0.7, 181);
  label.size_m = {0.09F, 0.12F};
  const float r = 0.42F * std::min(w, d), y = 0.0F;
  MeshBuilder& m = p.mesh;
  m.lathe(red, {0, y, 0},
          std::array<Vector2f, 7>{{{0.001F, 0},
                                   {0.9F * r, 0},
                                   {r, 0.02F},
                                   {r, 0.72F * h},
                                   {0.8F * r, 0.79F * h},
                                   {0.35F * r, 0.83F * h},
                                   {0.3F * r, 0.86F * h}}},
          24);
  m.cylinder(black, {0, y, 0.85F * h}, {0, y, 0.93F * h}, {0.3F * r, 0.28F * r}, 12);
  m.box(black, {-0.02F, y - 0.8F * r, 0.93F * h}, {0.02F, y + 0.4F * r, 0.96F * h});
  m.box(black, {-0.015F, y - 0.9F * r, 0.985F * h}, {0.015F, y + 0.3F * r, h});
  const std::array<Vector3f, 5> hose = {{{0.2F * r, y, 0.88F * h},
                                         {0.9F * r, y - 0.2F * r, 0.82F * h},
                                         {1.12F * r, y - 0.3F * r, 0.6F * h},
                                         {1.1F * r, y - 0.3F * r, 0.35F * h},
                                         {1.05F * r, y - 0.3F * r, 0.25F * h}}};
  m.tube(black, hose, 0.010F, 8);
  m.image(p.fixed(label), {-0.045F, y - r - 0.001F, 0.56F * h}, {0.09F, 0, 0}, {0, 0, -0.12F});
  m.box(black, {-0.03F, y + 0.9F * r, 0.5F * h}, {0.03F, d / 2, 0.6F * h});
}

void storage_shelf(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId metal = p.material("metal", public_steel());
  MeshBuilder& m = p.mesh;
  for (const float sx : {-1.0F, 1.0F})
    for (const float sy : {-1.0F, 1.0F}) {
      const float x = sx * (w / 2 - 0.0175F), y = sy * (d / 2 - 0.0175F);
      m.box(metal, {x - 0.0175F, y - 0.0175F, 0}, {x + 0.0175F, y + 0.0175F, h}, {.grain_axis = 2});
    }
  const int boards = std::max(3, static_cast<int>(h / 0.45F) + 1);
  const std::array<Rgb8, 4> cartons = {
      {{182, 146, 104}, {196, 164, 122}, {164, 128, 90}, {206, 204, 198}}};
  const std::array<Rgb8, 4> crates = {{{60, 90, 140}, {150, 60, 50}, {90, 94, 98}, {70, 120, 90}}};
  for (int i = 0; i < boards; ++i) {
    const float z = 0.08F + (h - 0.12F) * static_cast<float>(i) / static_cast<float>(boards - 1);
    m.box(metal, {-w / 2 + 0.002F, -d / 2 + 0.002F, z}, {w / 2 - 0.002F, d / 2 - 0.002F, z + 0.03F},
          {.bevel_m = 0.002F, .grain_axis = 0});
    const float room = i + 1 < boards ? (h - 0.12F) / static_cast<float>(boards - 1) - 0.05F : 0.0F;
    float x = -w / 2 + 0.05F;
    for (std::uint64_t k = 0; room > 0.1F && x < w / 2 - 0.2F; ++k) {
      const RandomStream r = p.random.fork(100 * static_cast<std::uint64_t>(i) + k);
      const auto bw = static_cast<float>(r.uniform(0, 0.2, 0.42)),
                 bd = static_cast<float>(r.uniform(1, 0.6, 0.92)) * d;
      const auto bh = static_cast<float>(r.uniform(2, 0.45, 0.95)) * room;
      if (x + bw > w / 2 - 0.04F) break;
      const float zz = z + 0.0305F, y0 = -0.5F * bd;
      if (r.uniform(3) < 0.18) {
        x += 0.6F * bw;
        continue;  // a gap
      }
      p.part(fmt::format("box_{}_{}", i + 1, k + 1), "box");
      if (r.uniform(4) < 0.7) {
        const MaterialId card = p.fixed(plain("plaster", cartons[r.below(5, 4)], 0.4, 182));
        m.box(card, {x, y0, zz}, {x + bw, -y0, zz + bh}, {.bevel_m = 0.004F});
        if (r.uniform(6) < 0.6) {
          MaterialSpec label = plain("paper", {236, 234, 228}, 0.6, 4000 + r.below(7, 900));
          label.size_m = {0.10F, 0.07F};
          m.image(p.fixed(label), {x + 0.5F * bw - 0.05F, y0 - 0.0008F, zz + 0.6F * bh},
                  {0.10F, 0, 0}, {0, 0, -0.07F});
        }
      } else {
        const MaterialId crate = p.fixed(plain("plastic", crates[r.below(5, 4)], 0.2, 183));
        m.box(crate, {x, y0, zz}, {x + bw, -y0, zz + 0.8F * bh}, {.bevel_m = 0.01F});
        m.box(crate, {x - 0.006F, y0 - 0.006F, zz + 0.8F * bh},
              {x + bw + 0.006F, -y0 + 0.006F, zz + 0.8F * bh + 0.025F}, {.bevel_m = 0.006F});
      }
      p.body();
      x += bw + static_cast<float>(r.uniform(8, 0.015, 0.07));
    }
  }
}

void base_counter(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak()),
                   top = p.material("top", plain("stone", {142, 138, 130}, 0.45, 26)),
                   metal = p.fixed(public_steel());
  MeshBuilder& m = p.mesh;
  const float y0 = -d / 2 + 0.05F, zt = h - 0.035F;
  m.box(wood, {-w / 2 + 0.01F, y0 + 0.05F, 0}, {w / 2 - 0.01F, d / 2, 0.099F});
  m.box(wood, {-w / 2, y0 + 0.001F, 0.10F}, {w / 2, d / 2, zt - 0.001F}, {.grain_axis = 2});
  const int n = std::max(1, static_cast<int>(std::lround(w / 0.5F)));
  const float each = w / static_cast<float>(n);
  for (int i = 0; i < n; ++i) {
    const float a = -w / 2 + each * static_cast<float>(i) + 0.003F, b = a + each - 0.006F,
                x = 0.5F * (a + b);
    const bool drawers = p.random.uniform(static_cast<std::uint64_t>(i)) < 0.4;
    const std::array<float, 4> z = drawers
                                       ? std::array<float, 4>{0.106F, 0.38F, 0.60F, zt - 0.006F}
                                       : std::array<float, 4>{0.106F, 0.62F, 0.62F, zt - 0.006F};
    for (std::size_t k = 0; k < 3; ++k) {
      if (z[k + 1] - z[k] < 0.05F) continue;
      m.box(wood, {a, y0 - 0.019F, z[k]}, {b, y0, z[k + 1] - 0.006F},
            {.bevel_m = 0.004F, .grain_axis = 2});
      handle(p, metal, {x - 0.3F * (b - x), y0 - 0.019F, z[k + 1] - 0.05F},
             {x + 0.3F * (b - x), y0 - 0.019F, z[k + 1] - 0.05F}, 0.026F);
    }
  }
  m.max_edge_m = 0.08F;
  m.box(top, {-w / 2, -d / 2 + 0.012F, zt}, {w / 2, d / 2, h},
        {.bevel_m = 0.003F, .grain_axis = 0});
  m.max_edge_m = 0.12F;
}

void vending_machine(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("plastic", {40, 70, 130}, 0.2, 184)),
                   black = p.fixed(rail_plastic());
  MeshBuilder& m = p.mesh;
  const float y = -d / 2 + 0.03F;
  m.box(body, {-w / 2, y, 0.03F}, {w / 2, d / 2, h}, {.bevel_m = 0.01F});
  m.box(black, {-w / 2 + 0.03F, y + 0.02F, 0}, {w / 2 - 0.03F, d / 2 - 0.02F, 0.029F},
        {.bevel_m = 0.0F});
  const float x1 = w / 2 - 0.24F;
  m.box(black, {-w / 2 + 0.04F, y - 0.006F, 0.42F}, {x1, y - 0.0005F, h - 0.10F},
        {.bevel_m = 0.0F});
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 7; ++i) {
      const RandomStream r = p.random.fork(static_cast<std::uint64_t>(10 * j + i));
      constexpr std::array<Rgb8, 6> kTones = {{{200, 50, 44},
                                               {50, 110, 60},
                                               {230, 180, 50},
                                               {40, 80, 160},
                                               {230, 230, 226},
                                               {150, 90, 40}}};
      const float each = (x1 + w / 2 - 0.08F) / 7.0F,
                  x = -w / 2 + 0.06F + each * static_cast<float>(i);
      const float z = 0.46F + (h - 0.60F) / 5.0F * static_cast<float>(j);
      m.box(p.fixed(plain("plastic", kTones[r.below(0, 6)], 0.3), {0.05F, 0.05F, 0.05F}),
            {x, y - 0.012F, z}, {x + 0.75F * each, y - 0.0065F, z + 0.14F}, {.bevel_m = 0.004F});
    }
  m.box(black, {-w / 2 + 0.06F, y - 0.004F, 0.14F}, {x1 - 0.02F, y - 0.0005F, 0.34F},
        {.bevel_m = 0.0F});
  m.box(black, {x1 + 0.05F, y - 0.006F, 1.0F}, {w / 2 - 0.04F, y - 0.0005F, 1.4F},
        {.bevel_m = 0.0F});
}

}  // namespace mh::build
