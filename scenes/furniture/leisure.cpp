// SPDX-License-Identifier: Apache-2.0
// What stands in gyms, game rooms, garages, laundries and closets.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

MaterialSpec steel() {
  return plain("brushed_metal", {160, 163, 166}, 0.3, 191);
}
MaterialSpec rubber() {
  return plain("plastic", {32, 33, 35}, 0.3, 192);
}

}  // namespace

void pool_table(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", plain("wood_grain", {104, 66, 42}, 0.5, 193));
  const MaterialId cloth = p.material("fabric", plain("fabric", {38, 112, 70}, 0.2, 194)),
                   black = p.fixed(rubber());
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
                 {x, s * (d / 2 - 0.75F * rim), h + 0.0F}, 0.055F, 0.055F, 18);
    for (const float sx : {-1.0F, 1.0F})
      m.cylinder(wood, {sx * (w / 2 - 0.28F), s * (d / 2 - 0.28F), 0},
                 {sx * (w / 2 - 0.28F), s * (d / 2 - 0.28F), bed - 0.14F}, 0.05F, 0.085F, 16);
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

void treadmill(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId black = p.fixed(rubber()),
                   gray = p.material("body", plain("plastic", {120, 122, 126}, 0.2, 195)),
                   metal = p.fixed(steel());
  MeshBuilder& m = p.mesh;
  // One steps on from the front (-y); the console stands at the back, which is to a wall.
  m.box(gray, {-w / 2, -d / 2, 0.03F}, {-w / 2 + 0.10F, d / 2 - 0.25F, 0.17F}, {.bevel_m = 0.015F});
  m.box(gray, {w / 2 - 0.10F, -d / 2, 0.03F}, {w / 2, d / 2 - 0.25F, 0.17F}, {.bevel_m = 0.015F});
  m.box(black, {-w / 2 + 0.101F, -d / 2 + 0.03F, 0.06F}, {w / 2 - 0.101F, d / 2 - 0.25F, 0.155F},
        {.bevel_m = 0.02F});
  m.box(gray, {-w / 2, d / 2 - 0.249F, 0}, {w / 2, d / 2, 0.26F}, {.bevel_m = 0.03F});
  for (const float s : {-1.0F, 1.0F}) {
    const float x = s * (w / 2 - 0.05F);
    m.beam(metal, {x, d / 2 - 0.12F, 0.2F}, {x, d / 2 - 0.26F, h - 0.12F}, 0.05F, 0.07F);
    const std::array<Vector3f, 3> rail = {{{x, d / 2 - 0.26F, h - 0.2F},
                                           {x, d / 2 - 0.60F, h - 0.24F},
                                           {x, d / 2 - 0.72F, h - 0.30F}}};
    m.tube(black, rail, 0.02F, 10);
  }
  m.push(translation(0, d / 2 - 0.28F, h - 0.16F) * turn(Vector3f::UnitX(), -0.5F));
  m.box(black, {-w / 2 + 0.03F, -0.03F, 0}, {w / 2 - 0.03F, 0.03F, 0.16F}, {.bevel_m = 0.012F});
  MaterialSpec screen = plain("screen", {70, 110, 130}, 0.7, 196);
  screen.size_m = {0.26F, 0.10F};
  m.picture(p.fixed(screen, {0.08F, 0.09F, 0.10F}), {-0.13F, -0.0315F, 0.13F}, {0.26F, 0, 0},
            {0, 0, -0.10F});
  m.pop();
}

void exercise_bike(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId black = p.fixed(rubber()),
                   frame = p.material("body", plain("plastic", {170, 50, 44}, 0.2, 197)),
                   metal = p.fixed(steel());
  MeshBuilder& m = p.mesh;
  for (const float s : {-1.0F, 1.0F})
    m.box(black, {-w / 2, s * (d / 2 - 0.04F) - 0.04F, 0},
          {w / 2, s * (d / 2 - 0.04F) + 0.04F, 0.06F}, {.bevel_m = 0.01F});
  m.beam(frame, {0, -d / 2 + 0.05F, 0.06F}, {0, d / 2 - 0.05F, 0.06F}, 0.06F, 0.05F);
  m.cylinder(frame, {-0.05F, 0.22F * d, 0.32F}, {0.05F, 0.22F * d, 0.32F}, 0.25F, 0.25F, 36);
  m.cylinder(metal, {-0.053F, 0.22F * d, 0.32F}, {0.053F, 0.22F * d, 0.32F}, 0.16F, 0.16F, 30);
  m.beam(frame, {0, -0.20F * d, 0.06F}, {0, -0.26F * d, 0.78F * h}, 0.05F, 0.07F);
  m.cushion(black, {0, -0.26F * d, 0.80F * h}, {0.24F, 0.27F, 0.08F}, 0.035F, 0.0F, 0.05F);
  m.beam(frame, {0, 0.20F * d, 0.5F}, {0, 0.30F * d, 0.92F * h}, 0.05F, 0.06F);
  const std::array<Vector3f, 4> bar = {{{-0.22F, 0.10F * d, h - 0.02F},
                                        {-0.18F, 0.28F * d, 0.93F * h},
                                        {0.18F, 0.28F * d, 0.93F * h},
                                        {0.22F, 0.10F * d, h - 0.02F}}};
  m.tube(black, bar, 0.018F, 10);
  m.box(black, {-0.09F, 0.29F * d, 0.93F * h}, {0.09F, 0.33F * d, h}, {.bevel_m = 0.01F});
  m.cylinder(metal, {-0.14F, 0.0F, 0.30F}, {0.14F, 0.0F, 0.30F}, 0.018F, 0.018F, 10);
  m.beam(metal, {0.12F, 0, 0.30F}, {0.12F, 0.12F, 0.18F}, 0.025F, 0.015F);
  m.beam(metal, {-0.12F, 0, 0.30F}, {-0.12F, -0.12F, 0.42F}, 0.025F, 0.015F);
  m.box(black, {0.11F, 0.07F, 0.165F}, {0.21F, 0.16F, 0.19F});
  m.box(black, {-0.21F, -0.16F, 0.405F}, {-0.11F, -0.07F, 0.43F});
}

void dumbbell_rack(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId metal = p.material("metal", steel()), black = p.fixed(rubber()),
                   chrome = p.fixed(plain("brushed_metal", {196, 198, 200}, 0.2, 198));
  MeshBuilder& m = p.mesh;
  for (const float s : {-1.0F, 1.0F}) {
    const float x = s * (w / 2 - 0.03F);
    m.beam(metal, {x, -d / 2 + 0.03F, 0.02F}, {x, d / 2 - 0.05F, h}, 0.05F, 0.05F);
    m.box(metal, {x - 0.03F, -d / 2, 0}, {x + 0.03F, d / 2, 0.04F});
  }
  const int rows = 3, n = static_cast<int>((w - 0.12F) / 0.16F);
  for (int j = 0; j < rows; ++j) {
    const float t = (static_cast<float>(j) + 0.6F) / static_cast<float>(rows), z = t * (h - 0.16F),
                y = -d / 2 + 0.10F + t * (d - 0.28F);
    m.box(metal, {-w / 2 + 0.06F, y - 0.08F, z}, {w / 2 - 0.06F, y - 0.05F, z + 0.02F});
    m.box(metal, {-w / 2 + 0.06F, y + 0.05F, z}, {w / 2 - 0.06F, y + 0.08F, z + 0.02F});
    p.part(fmt::format("dumbbells_{}", j + 1), "otherprop");
    for (int i = 0; i < n; ++i) {
      const float x = -w / 2 + 0.13F + 0.16F * static_cast<float>(i),
                  r = 0.035F + 0.004F * static_cast<float>(i % 6) +
                      0.006F * static_cast<float>(rows - j);
      const float zz = z + 0.02F + r;
      m.cylinder(chrome, {x, y - 0.08F, zz}, {x, y + 0.08F, zz}, 0.014F, 0.014F, 10, false);
      for (const float s : {-1.0F, 1.0F})
        m.cylinder(black, {x, y + s * 0.06F, zz}, {x, y + s * 0.13F, zz}, r, 0.92F * r, 14);
    }
    p.body();
  }
}

void weight_bench(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId pad = p.material("fabric", plain("leather", {40, 40, 44}, 0.3, 199)),
                   metal = p.material("metal", steel()), black = p.fixed(rubber());
  MeshBuilder& m = p.mesh;
  m.cushion(pad, {0, -0.06F * d, 0.42F}, {0.30F, 0.80F * d, 0.09F}, 0.03F, 0.004F, 0.06F);
  m.beam(metal, {0, -0.40F * d, 0.35F}, {0, 0.40F * d, 0.35F}, 0.06F, 0.05F);
  m.beam(metal, {0, -0.38F * d, 0.02F}, {0, -0.36F * d, 0.35F}, 0.06F, 0.05F);
  m.box(metal, {-0.22F, -0.42F * d, 0}, {0.22F, -0.36F * d, 0.04F});
  const float r0 = std::min(0.17F, 0.11F * d), z = h - r0;  // of the weights: the highest part
  for (const float s : {-1.0F, 1.0F}) {
    const float x = s * 0.46F * std::min(w, 1.1F);
    m.beam(metal, {x, 0.40F * d, 0}, {x, 0.40F * d, z}, 0.05F, 0.05F);
    m.beam(metal, {x, 0.36F * d, z - 0.045F}, {x, 0.36F * d, z + 0.025F}, 0.04F, 0.02F);
  }
  m.beam(metal, {-0.46F * std::min(w, 1.1F), 0.40F * d, 0.3F},
         {0.46F * std::min(w, 1.1F), 0.40F * d, 0.3F}, 0.05F, 0.05F, {0, 0, 1});
  m.cylinder(metal, {-w / 2, 0.38F * d, z}, {w / 2, 0.38F * d, z}, 0.014F, 0.014F, 12);
  for (const float s : {-1.0F, 1.0F})
    for (const auto& [at, r] : {std::pair{0.08F, 0.17F}, std::pair{0.13F, 0.13F}})
      m.cylinder(black, {s * (w / 2 - at), 0.38F * d, z}, {s * (w / 2 - at - 0.04F), 0.38F * d, z},
                 std::min(r, 0.11F * d), std::min(r, 0.11F * d), 30);
}

void exercise_ball(Piece& p) {
  const float s = p.size_m.minCoeff();
  const MaterialId body = p.material("body", plain("plastic", {90, 110, 160}, 0.2, 200));
  p.mesh.cushion(body, {0, 0, s / 2}, {s, s, s}, 0.499F * s, 0.0F, 0.05F);
}

void yoga_mat(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  p.mesh.box(p.material("top", plain("plastic", {96, 84, 140}, 0.3, 201)), {-w / 2, -d / 2, 0},
             {w / 2, d / 2, h}, {.bevel_m = 0.0F});
}

void ironing_board(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId cloth = p.material("fabric", plain("fabric", {150, 170, 190}, 0.6, 202)),
                   metal = p.fixed(steel());
  MeshBuilder& m = p.mesh;
  std::vector<Vector2f> outline;
  for (int i = 0; i <= 16; ++i) {
    const float t = static_cast<float>(i) / 16.0F;
    outline.emplace_back(
        -w / 2 + t * w,
        -d / 2 * std::pow(std::max(0.0F, 1.0F - std::pow(t, 5.0F)), 0.5F) * (1.0F - 0.25F * t));
  }
  for (int i = 15; i >= 0; --i)
    outline.emplace_back(outline[static_cast<std::size_t>(i)].x(),
                         -outline[static_cast<std::size_t>(i)].y());
  m.prism(cloth, outline, h - 0.03F, h);
  for (const float s : {-1.0F, 1.0F}) {
    m.cylinder(metal, {s * 0.38F * w, -0.4F * d, 0.01F}, {-s * 0.30F * w, -0.3F * d, h - 0.031F},
               0.012F, 0.012F, 8);
    m.cylinder(metal, {s * 0.38F * w, 0.4F * d, 0.01F}, {-s * 0.30F * w, 0.3F * d, h - 0.031F},
               0.012F, 0.012F, 8);
    m.cylinder(metal, {s * 0.38F * w, -0.42F * d, 0.012F}, {s * 0.38F * w, 0.42F * d, 0.012F},
               0.012F, 0.012F, 8);
  }
}

void workbench(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", plain("wood_grain", {176, 136, 92}, 0.6, 203)),
                   metal = p.fixed(steel());
  const MaterialId red = p.fixed(plain("plastic", {170, 46, 40}, 0.2, 204));
  MeshBuilder& m = p.mesh;
  m.max_edge_m = 0.08F;
  m.box(wood, {-w / 2, -d / 2, h - 0.05F}, {w / 2, d / 2, h}, {.bevel_m = 0.006F, .grain_axis = 0});
  m.max_edge_m = 0.12F;
  for (const float sx : {-1.0F, 1.0F})
    for (const float sy : {-1.0F, 1.0F})
      m.box(wood, {sx * (w / 2 - 0.07F) - 0.045F, sy * (d / 2 - 0.07F) - 0.045F, 0},
            {sx * (w / 2 - 0.07F) + 0.045F, sy * (d / 2 - 0.07F) + 0.045F, h - 0.051F},
            {.grain_axis = 2});
  m.box(wood, {-w / 2 + 0.12F, -d / 2 + 0.05F, 0.18F}, {w / 2 - 0.12F, d / 2 - 0.05F, 0.205F},
        {.grain_axis = 0});
  p.part("toolbox", "box");
  m.box(red, {-0.35F * w, -0.12F, 0.206F}, {-0.35F * w + 0.42F, 0.10F, 0.40F}, {.bevel_m = 0.008F});
  m.cylinder(metal, {-0.35F * w + 0.1F, 0, 0.43F}, {-0.35F * w + 0.32F, 0, 0.43F}, 0.01F, 0.01F, 8);
  p.body();
}

void tool_board(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId board = p.material("wood", plain("wood_grain", {190, 156, 112}, 0.3, 205)),
                   metal = p.fixed(steel());
  MeshBuilder& m = p.mesh;
  m.box(board, {-w / 2, d / 2 - 0.012F, 0}, {w / 2, d / 2, h}, {.bevel_m = 0.0F});
  constexpr std::array<Rgb8, 4> kGrips = {
      {{190, 50, 40}, {220, 160, 40}, {40, 70, 120}, {40, 40, 42}}};
  const int n = std::max(3, static_cast<int>(w / 0.12F));
  p.part("tools", "otherprop");
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < n; ++i) {
      const RandomStream r = p.random.fork(static_cast<std::uint64_t>(20 * j + i));
      const float x = -w / 2 + (static_cast<float>(i) + 0.5F) * w / static_cast<float>(n),
                  top = h * (j == 0 ? 0.95F : 0.48F), y = d / 2 - 0.03F;
      const MaterialId grip = p.fixed(plain("plastic", kGrips[r.below(0, 4)], 0.2, 206));
      const auto long_m = static_cast<float>(r.uniform(1, 0.25, 0.42)) * h;
      const auto what = r.below(2, 4);
      if (what == 0) {  // hammer
        m.cylinder(grip, {x, y, top - long_m}, {x, y, top - 0.03F}, 0.013F, 0.011F, 8);
        m.cylinder(metal, {x - 0.05F, y, top - 0.03F}, {x + 0.05F, y, top - 0.03F}, 0.015F, 0.015F,
                   10);
      } else if (what == 1) {  // screwdriver
        m.cylinder(metal, {x, y, top - long_m}, {x, y, top - 0.1F}, 0.004F, 0.004F, 6);
        m.cylinder(grip, {x, y, top - 0.11F}, {x, y, top}, 0.013F, 0.016F, 10);
      } else if (what == 2) {  // spanner
        m.box(metal, {x - 0.01F, y - 0.003F, top - long_m}, {x + 0.01F, y + 0.003F, top},
              {.bevel_m = 0.0F});
        for (const float z : {top - long_m, top - 0.02F})
          m.cylinder(metal, {x, y - 0.004F, z}, {x, y + 0.004F, z}, 0.022F, 0.022F, 8);
      } else {  // saw or pliers
        m.box(grip, {x - 0.03F, y - 0.012F, top - 0.11F}, {x + 0.03F, y + 0.012F, top},
              {.bevel_m = 0.008F});
        m.box(metal, {x - 0.022F, y - 0.001F, top - long_m}, {x + 0.022F, y + 0.001F, top - 0.111F},
              {.bevel_m = 0.0F});
      }
    }
  p.body();
}

void bicycle(Piece& p) {
  const float w = p.size_m.x(), h = p.size_m.z();
  const MaterialId frame = p.material("body", plain("plastic", {40, 90, 150}, 0.2, 207)),
                   black = p.fixed(rubber()), metal = p.fixed(steel());
  MeshBuilder& m = p.mesh;
  const float r = 0.335F, tire = 0.018F, rear = -w / 2 + r + tire, front = w / 2 - r - tire;
  for (const float x : {rear, front}) {
    std::vector<Vector3f> rim;
    for (int i = 0; i <= 40; ++i) {
      const float a = 6.2831853F * static_cast<float>(i % 40) / 40.0F;
      rim.emplace_back(x + r * std::cos(a), 0, r + tire + r * std::sin(a));
    }
    m.tube(black, rim, tire, 8);
    for (int i = 0; i < 14; ++i) {
      const float a = 6.2831853F * static_cast<float>(i) / 14.0F;
      m.cylinder(metal, {x, 0, r + tire},
                 {x + (r - 0.01F) * std::cos(a), 0, r + tire + (r - 0.01F) * std::sin(a)}, 0.0018F,
                 0.0018F, 4, false);
    }
    m.cylinder(metal, {x, -0.05F, r + tire}, {x, 0.05F, r + tire}, 0.02F, 0.02F, 10);
  }
  const Vector3f crank(rear + 0.46F, 0, 0.29F), seat(rear + 0.30F, 0, 0.86F * h),
      head(front - 0.14F, 0, 0.82F * h), hub(front, 0, r + tire), back(rear, 0, r + tire);
  for (const auto& [a, b, t] : {std::tuple{crank, seat, 0.018F}, std::tuple{crank, head, 0.022F},
                                std::tuple{Vector3f(seat + 0.14F * (crank - seat)), head, 0.018F},
                                std::tuple{back, crank, 0.011F},
                                std::tuple{back, Vector3f(seat + 0.12F * (crank - seat)), 0.010F},
                                std::tuple{hub, head, 0.016F}})
    m.cylinder(frame, a, b, t, t, 10);
  m.cylinder(metal, seat, seat + Vector3f(-0.02F, 0, 0.05F), 0.013F, 0.013F, 8);
  m.cushion(black, seat + Vector3f(-0.02F, 0, 0.07F), {0.26F, 0.13F, 0.06F}, 0.027F, 0.0F, 0.05F);
  m.cylinder(metal, head, head + Vector3f(-0.02F, 0, 0.12F), 0.013F, 0.013F, 8);
  const Vector3f bar = head + Vector3f(-0.02F, 0, 0.12F);
  const float reach = std::min(0.28F, 0.5F * p.size_m.y() - 0.01F);
  const std::array<Vector3f, 4> grip = {bar + Vector3f(-0.06F, -reach, 0.02F),
                                        bar + Vector3f(0, -0.06F, 0), bar + Vector3f(0, 0.06F, 0),
                                        bar + Vector3f(-0.06F, reach, 0.02F)};
  m.tube(black, grip, 0.012F, 8);
  m.cylinder(metal, crank - Vector3f(0, 0.03F, 0), crank + Vector3f(0, 0.03F, 0), 0.09F, 0.09F, 24);
  m.beam(metal, crank + Vector3f(0, -0.05F, 0), crank + Vector3f(0.13F, -0.05F, -0.10F), 0.02F,
         0.012F);
  m.beam(metal, crank + Vector3f(0, 0.05F, 0), crank + Vector3f(-0.13F, 0.05F, 0.10F), 0.02F,
         0.012F);
  m.beam(metal, crank + Vector3f(0.02F, 0.03F, 0),
         crank + Vector3f(-0.05F, std::min(0.16F, reach), -crank.z() + 0.005F), 0.014F,
         0.014F);  // stand
}

void ladder(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId metal = p.material("metal", steel()), black = p.fixed(rubber());
  MeshBuilder& m = p.mesh;
  for (const float s : {-1.0F, 1.0F}) {
    m.beam(metal, {s * (w / 2 - 0.03F), -d / 2 + 0.03F, 0.0F},
           {s * (w / 2 - 0.08F), 0.02F, h - 0.02F}, 0.025F, 0.06F);
    m.beam(metal, {s * (w / 2 - 0.03F), d / 2 - 0.03F, 0.0F},
           {s * (w / 2 - 0.08F), 0.05F, h - 0.05F}, 0.025F, 0.04F);
  }
  const int steps = std::max(3, static_cast<int>(h / 0.27F));
  for (int i = 1; i < steps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(steps),
                x = w / 2 - 0.03F - 0.05F * t, y = -d / 2 + 0.03F + t * (d / 2 - 0.01F);
    m.box(metal, {-x, y - 0.03F, t * h - 0.012F}, {x, y + 0.05F, t * h + 0.012F});
  }
  m.box(black, {-w / 2 + 0.06F, -0.05F, h - 0.04F}, {w / 2 - 0.06F, 0.07F, h}, {.bevel_m = 0.008F});
}

void clothes_rack(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId metal = p.material("metal", steel());
  MeshBuilder& m = p.mesh;
  for (const float s : {-1.0F, 1.0F}) {
    m.cylinder(metal, {s * (w / 2 - 0.02F), 0, 0.03F}, {s * (w / 2 - 0.02F), 0, h}, 0.014F, 0.014F,
               10);
    m.box(metal, {s * (w / 2 - 0.02F) - 0.018F, -d / 2, 0},
          {s * (w / 2 - 0.02F) + 0.018F, d / 2, 0.03F});
  }
  m.cylinder(metal, {-w / 2 + 0.02F, 0, h - 0.02F}, {w / 2 - 0.02F, 0, h - 0.02F}, 0.013F, 0.013F,
             10);
  constexpr std::array<Rgb8, 8> kTones = {{{58, 70, 92},
                                           {150, 66, 52},
                                           {126, 118, 92},
                                           {40, 42, 46},
                                           {206, 200, 190},
                                           {90, 120, 104},
                                           {170, 140, 160},
                                           {110, 80, 60}}};
  const int n = std::max(3, static_cast<int>((w - 0.16F) / 0.085F));
  for (int i = 0; i < n; ++i) {  // hung sideways, one behind the other
    const RandomStream r = p.random.fork(static_cast<std::uint64_t>(i));
    if (r.uniform(0) < 0.12) continue;
    const float x = -w / 2 + 0.1F + 0.085F * static_cast<float>(i);
    p.part(fmt::format("garment_{}", i + 1), "clothes");
    const MaterialId cloth = p.fixed(plain(r.uniform(1) < 0.3 ? "knit" : "fabric",
                                           kTones[r.below(2, 8)], 0.5, 208 + r.below(3, 3)));
    const auto tall = static_cast<float>(r.uniform(4, 0.55, 1.05)) * std::min(1.0F, h - 0.25F),
               phase = static_cast<float>(r.uniform(5, 0.0, 6.28));
    for (const float side : {-1.0F, 1.0F})
      m.sheet(cloth,
              [&](float s, float t) -> Vector3f {
                const float u = 2.0F * s - 1.0F, half = 0.44F * d * (0.86F + 0.14F * t);
                const float swell =
                    side * (0.012F + 0.022F * std::sqrt(std::max(0.0F, 1.0F - u * u))) +
                    0.008F * t * std::sin(9.0F * u + phase);
                return {x + swell, half * u, h - 0.06F - 0.05F * u * u * (1.0F - t) - t * tall};
              },
              12, 10, {d, tall});
    p.body();
  }
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
               {x + 0.18F, 0.03F, 0.11F + 0.06F * static_cast<float>((i + 1) % 2)}, 0.045F, 0.04F,
               12);
  }
}

void piano(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", plain("wood_grain", {60, 40, 30}, 0.3, 214)),
                   white = p.fixed(plain("ceramic", {236, 234, 224}, 0.05, 215)),
                   black = p.fixed(rubber());
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
  m.picture(p.fixed(sheet), {-0.21F, d / 2 - deep - 0.012F, keys + 0.46F}, {0.42F, 0, 0},
            {0, 0.006F, -0.28F});
}

void stool(Piece& p) {
  const float w = p.size_m.x(), h = p.size_m.z();
  const MaterialId pad = p.material("fabric", plain("leather", {60, 44, 38}, 0.4, 217)),
                   metal = p.material("metal", steel());
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
               {0.6F * r * std::cos(a), 0.6F * r * std::sin(a), h - 0.07F}, 0.012F, 0.012F, 8);
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
  m.cylinder(black, {0, 0, 0}, {0, 0, 0.8F * d}, r, r, 40);
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
  m.cylinder(red, {0, 0, z - 0.001F}, {0, 0, d}, 0.06F * r, 0.06F * r, 16);
  m.pop();
}

}  // namespace mh::build
