// SPDX-License-Identifier: Apache-2.0
// Things in workshops, garages, laundries and closets.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector2f;
using Eigen::Vector3f;

void ironing_board(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId cloth = p.material("fabric", plain("fabric", {150, 170, 190}, 0.6, 202)),
                   metal = p.fixed(bare_steel());
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
               {0.012F, 0.012F}, 8);
    m.cylinder(metal, {s * 0.38F * w, 0.4F * d, 0.01F}, {-s * 0.30F * w, 0.3F * d, h - 0.031F},
               {0.012F, 0.012F}, 8);
    m.cylinder(metal, {s * 0.38F * w, -0.42F * d, 0.012F}, {s * 0.38F * w, 0.42F * d, 0.012F},
               {0.012F, 0.012F}, 8);
  }
}

void workbench(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", plain("wood_grain", {176, 136, 92}, 0.6, 203)),
                   metal = p.fixed(bare_steel());
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
  m.cylinder(metal, {-0.35F * w + 0.1F, 0, 0.43F}, {-0.35F * w + 0.32F, 0, 0.43F}, {0.01F, 0.01F},
             8);
  p.body();
}

void tool_board(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId board = p.material("wood", plain("wood_grain", {190, 156, 112}, 0.3, 205)),
                   metal = p.fixed(bare_steel());
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
        m.cylinder(grip, {x, y, top - long_m}, {x, y, top - 0.03F}, {0.013F, 0.011F}, 8);
        m.cylinder(metal, {x - 0.05F, y, top - 0.03F}, {x + 0.05F, y, top - 0.03F},
                   {0.015F, 0.015F}, 10);
      } else if (what == 1) {  // screwdriver
        m.cylinder(metal, {x, y, top - long_m}, {x, y, top - 0.1F}, {0.004F, 0.004F}, 6);
        m.cylinder(grip, {x, y, top - 0.11F}, {x, y, top}, {0.013F, 0.016F}, 10);
      } else if (what == 2) {  // wrench
        m.box(metal, {x - 0.01F, y - 0.003F, top - long_m}, {x + 0.01F, y + 0.003F, top},
              {.bevel_m = 0.0F});
        for (const float z : {top - long_m, top - 0.02F})
          m.cylinder(metal, {x, y - 0.004F, z}, {x, y + 0.004F, z}, {0.022F, 0.022F}, 8);
      } else {  // saw or pliers
        m.box(grip, {x - 0.03F, y - 0.012F, top - 0.11F}, {x + 0.03F, y + 0.012F, top},
              {.bevel_m = 0.008F});
        m.box(metal, {x - 0.022F, y - 0.001F, top - long_m}, {x + 0.022F, y + 0.001F, top - 0.111F},
              {.bevel_m = 0.0F});
      }
    }
  p.body();
}

void ladder(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId metal = p.material("metal", bare_steel()), black = p.fixed(black_rubber());
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
  const MaterialId metal = p.material("metal", bare_steel());
  MeshBuilder& m = p.mesh;
  for (const float s : {-1.0F, 1.0F}) {
    m.cylinder(metal, {s * (w / 2 - 0.02F), 0, 0.03F}, {s * (w / 2 - 0.02F), 0, h},
               {0.014F, 0.014F}, 10);
    m.box(metal, {s * (w / 2 - 0.02F) - 0.018F, -d / 2, 0},
          {s * (w / 2 - 0.02F) + 0.018F, d / 2, 0.03F});
  }
  m.cylinder(metal, {-w / 2 + 0.02F, 0, h - 0.02F}, {w / 2 - 0.02F, 0, h - 0.02F}, {0.013F, 0.013F},
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

}  // namespace mh::build
