// SPDX-License-Identifier: Apache-2.0
// Gym equipment and bicycles.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector3f;

void treadmill(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId black = p.fixed(black_rubber()),
                   gray = p.material("body", plain("plastic", {120, 122, 126}, 0.2, 195)),
                   metal = p.fixed(bare_steel());
  MeshBuilder& m = p.mesh;
  // The user steps on from the front (-y); the console is at the back, which faces a wall.
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
  m.image(p.fixed(screen, {0.08F, 0.09F, 0.10F}), {-0.13F, -0.0315F, 0.13F}, {0.26F, 0, 0},
          {0, 0, -0.10F});
  m.pop();
}

void exercise_bike(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId black = p.fixed(black_rubber()),
                   frame = p.material("body", plain("plastic", {170, 50, 44}, 0.2, 197)),
                   metal = p.fixed(bare_steel());
  MeshBuilder& m = p.mesh;
  for (const float s : {-1.0F, 1.0F})
    m.box(black, {-w / 2, s * (d / 2 - 0.04F) - 0.04F, 0},
          {w / 2, s * (d / 2 - 0.04F) + 0.04F, 0.06F}, {.bevel_m = 0.01F});
  m.beam(frame, {0, -d / 2 + 0.05F, 0.06F}, {0, d / 2 - 0.05F, 0.06F}, 0.06F, 0.05F);
  m.cylinder(frame, {-0.05F, 0.22F * d, 0.32F}, {0.05F, 0.22F * d, 0.32F}, {0.25F, 0.25F}, 36);
  m.cylinder(metal, {-0.053F, 0.22F * d, 0.32F}, {0.053F, 0.22F * d, 0.32F}, {0.16F, 0.16F}, 30);
  m.beam(frame, {0, -0.20F * d, 0.06F}, {0, -0.26F * d, 0.78F * h}, 0.05F, 0.07F);
  m.cushion(black, {0, -0.26F * d, 0.80F * h}, {0.24F, 0.27F, 0.08F}, 0.035F, 0.0F, 0.05F);
  m.beam(frame, {0, 0.20F * d, 0.5F}, {0, 0.30F * d, 0.92F * h}, 0.05F, 0.06F);
  const std::array<Vector3f, 4> bar = {{{-0.22F, 0.10F * d, h - 0.02F},
                                        {-0.18F, 0.28F * d, 0.93F * h},
                                        {0.18F, 0.28F * d, 0.93F * h},
                                        {0.22F, 0.10F * d, h - 0.02F}}};
  m.tube(black, bar, 0.018F, 10);
  m.box(black, {-0.09F, 0.29F * d, 0.93F * h}, {0.09F, 0.33F * d, h}, {.bevel_m = 0.01F});
  m.cylinder(metal, {-0.14F, 0.0F, 0.30F}, {0.14F, 0.0F, 0.30F}, {0.018F, 0.018F}, 10);
  m.beam(metal, {0.12F, 0, 0.30F}, {0.12F, 0.12F, 0.18F}, 0.025F, 0.015F);
  m.beam(metal, {-0.12F, 0, 0.30F}, {-0.12F, -0.12F, 0.42F}, 0.025F, 0.015F);
  m.box(black, {0.11F, 0.07F, 0.165F}, {0.21F, 0.16F, 0.19F});
  m.box(black, {-0.21F, -0.16F, 0.405F}, {-0.11F, -0.07F, 0.43F});
}

void dumbbell_rack(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId metal = p.material("metal", bare_steel()), black = p.fixed(black_rubber()),
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
      m.cylinder(chrome, {x, y - 0.08F, zz}, {x, y + 0.08F, zz}, {0.014F, 0.014F}, 10, false);
      for (const float s : {-1.0F, 1.0F})
        m.cylinder(black, {x, y + s * 0.06F, zz}, {x, y + s * 0.13F, zz}, {r, 0.92F * r}, 14);
    }
    p.body();
  }
}

void weight_bench(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId pad = p.material("fabric", plain("leather", {40, 40, 44}, 0.3, 199)),
                   metal = p.material("metal", bare_steel()), black = p.fixed(black_rubber());
  MeshBuilder& m = p.mesh;
  m.cushion(pad, {0, -0.06F * d, 0.42F}, {0.30F, 0.80F * d, 0.09F}, 0.03F, 0.004F, 0.06F);
  m.beam(metal, {0, -0.40F * d, 0.35F}, {0, 0.40F * d, 0.35F}, 0.06F, 0.05F);
  m.beam(metal, {0, -0.38F * d, 0.02F}, {0, -0.36F * d, 0.35F}, 0.06F, 0.05F);
  m.box(metal, {-0.22F, -0.42F * d, 0}, {0.22F, -0.36F * d, 0.04F});
  const float r0 = std::min(0.17F, 0.11F * d), z = h - r0;  // of the weights, the highest part
  for (const float s : {-1.0F, 1.0F}) {
    const float x = s * 0.46F * std::min(w, 1.1F);
    m.beam(metal, {x, 0.40F * d, 0}, {x, 0.40F * d, z}, 0.05F, 0.05F);
    m.beam(metal, {x, 0.36F * d, z - 0.045F}, {x, 0.36F * d, z + 0.025F}, 0.04F, 0.02F);
  }
  m.beam(metal, {-0.46F * std::min(w, 1.1F), 0.40F * d, 0.3F},
         {0.46F * std::min(w, 1.1F), 0.40F * d, 0.3F}, 0.05F, 0.05F, {0, 0, 1});
  m.cylinder(metal, {-w / 2, 0.38F * d, z}, {w / 2, 0.38F * d, z}, {0.014F, 0.014F}, 12);
  for (const float s : {-1.0F, 1.0F})
    for (const auto& [at, r] : {std::pair{0.08F, 0.17F}, std::pair{0.13F, 0.13F}})
      m.cylinder(black, {s * (w / 2 - at), 0.38F * d, z}, {s * (w / 2 - at - 0.04F), 0.38F * d, z},
                 {std::min(r, 0.11F * d), std::min(r, 0.11F * d)}, 30);
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

void bicycle(Piece& p) {
  const float w = p.size_m.x(), h = p.size_m.z();
  const MaterialId frame = p.material("body", plain("plastic", {40, 90, 150}, 0.2, 207)),
                   black = p.fixed(black_rubber()), metal = p.fixed(bare_steel());
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
                 {x + (r - 0.01F) * std::cos(a), 0, r + tire + (r - 0.01F) * std::sin(a)},
                 {0.0018F, 0.0018F}, 4, false);
    }
    m.cylinder(metal, {x, -0.05F, r + tire}, {x, 0.05F, r + tire}, {0.02F, 0.02F}, 10);
  }
  const Vector3f crank(rear + 0.46F, 0, 0.29F), seat(rear + 0.30F, 0, 0.86F * h),
      head(front - 0.14F, 0, 0.82F * h), hub(front, 0, r + tire), back(rear, 0, r + tire);
  for (const auto& [a, b, t] : {std::tuple{crank, seat, 0.018F}, std::tuple{crank, head, 0.022F},
                                std::tuple{Vector3f(seat + 0.14F * (crank - seat)), head, 0.018F},
                                std::tuple{back, crank, 0.011F},
                                std::tuple{back, Vector3f(seat + 0.12F * (crank - seat)), 0.010F},
                                std::tuple{hub, head, 0.016F}})
    m.cylinder(frame, a, b, {t, t}, 10);
  m.cylinder(metal, seat, seat + Vector3f(-0.02F, 0, 0.05F), {0.013F, 0.013F}, 8);
  m.cushion(black, seat + Vector3f(-0.02F, 0, 0.07F), {0.26F, 0.13F, 0.06F}, 0.027F, 0.0F, 0.05F);
  m.cylinder(metal, head, head + Vector3f(-0.02F, 0, 0.12F), {0.013F, 0.013F}, 8);
  const Vector3f bar = head + Vector3f(-0.02F, 0, 0.12F);
  const float reach = std::min(0.28F, 0.5F * p.size_m.y() - 0.01F);
  const std::array<Vector3f, 4> grip = {bar + Vector3f(-0.06F, -reach, 0.02F),
                                        bar + Vector3f(0, -0.06F, 0), bar + Vector3f(0, 0.06F, 0),
                                        bar + Vector3f(-0.06F, reach, 0.02F)};
  m.tube(black, grip, 0.012F, 8);
  m.cylinder(metal, crank - Vector3f(0, 0.03F, 0), crank + Vector3f(0, 0.03F, 0), {0.09F, 0.09F},
             24);
  m.beam(metal, crank + Vector3f(0, -0.05F, 0), crank + Vector3f(0.13F, -0.05F, -0.10F), 0.02F,
         0.012F);
  m.beam(metal, crank + Vector3f(0, 0.05F, 0), crank + Vector3f(-0.13F, 0.05F, 0.10F), 0.02F,
         0.012F);
  m.beam(metal, crank + Vector3f(0.02F, 0.03F, 0),
         crank + Vector3f(-0.05F, std::min(0.16F, reach), -crank.z() + 0.005F), 0.014F,
         0.014F);  // stand
}

}  // namespace mh::build
