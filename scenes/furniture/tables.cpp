// SPDX-License-Identifier: Apache-2.0
#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector3f;

namespace {

/// A top on four legs with an apron under its edge.
void four_legs(Piece& p, MaterialId wood, float top, float leg, float inset, float apron) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  MeshBuilder& m = p.mesh;
  m.max_edge_m = 0.07F;  // fine enough for the shadows of things on the top
  m.box(wood, {-w / 2, -d / 2, h - top}, {w / 2, d / 2, h}, {.bevel_m = 0.006F, .grain_axis = 0});
  m.max_edge_m = 0.12F;
  const float x = w / 2 - inset - leg / 2, y = d / 2 - inset - leg / 2;
  for (const float sx : {-1.0F, 1.0F})
    for (const float sy : {-1.0F, 1.0F})
      m.box(wood, {sx * x - leg / 2, sy * y - leg / 2, 0},
            {sx * x + leg / 2, sy * y + leg / 2, h - top - 0.001F});
  if (apron <= 0.0F) return;
  const float z = h - top - 0.001F;
  for (const float s : {-1.0F, 1.0F}) {
    m.box(wood, {-x + leg / 2 + 0.001F, s * y - 0.011F, z - apron},
          {x - leg / 2 - 0.001F, s * y + 0.011F, z});
    m.box(wood, {s * x - 0.011F, -y + leg / 2 + 0.001F, z - apron},
          {s * x + 0.011F, y - leg / 2 - 0.001F, z});
  }
}

/// A drawer front with a knob.
void drawer(Piece& p, MaterialId wood, MaterialId knob, const Front& front) {
  const auto& [x0, x1, y, z0, z1] = front;
  p.mesh.box(wood, {x0, y - 0.018F, z0}, {x1, y, z1}, {.bevel_m = 0.005F, .grain_axis = 0});
  const float x = 0.5F * (x0 + x1), z = 0.5F * (z0 + z1);
  p.mesh.cylinder(knob, {x, y - 0.016F, z}, {x, y - 0.034F, z}, {0.008F, 0.014F}, 10);
}

}  // namespace

void dining_table(Piece& p) {
  four_legs(p, p.material("wood", oak()), 0.032F, 0.065F, 0.03F, 0.08F);
}

void coffee_table(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y();
  const MaterialId wood = p.material("wood", oak());
  four_legs(p, wood, 0.028F, 0.045F, 0.02F, 0.05F);
  p.mesh.box(wood, {-w / 2 + 0.07F, -d / 2 + 0.07F, 0.12F}, {w / 2 - 0.07F, d / 2 - 0.07F, 0.138F},
             {.bevel_m = 0.004F, .grain_axis = 0});  // lower board
}

void console_table(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak());
  const MaterialId knob = p.fixed(plain("brushed_metal", {150, 130, 90}, 0.3, 5));
  four_legs(p, wood, 0.025F, 0.04F, 0.015F, 0.0F);
  p.mesh.box(wood, {-w / 2 + 0.056F, -d / 2 + 0.04F, h - 0.16F},
             {w / 2 - 0.056F, d / 2 - 0.02F, h - 0.026F});
  drawer(p, wood, knob, {-w / 2 + 0.07F, -0.005F, -d / 2 + 0.04F, h - 0.15F, h - 0.035F});
  drawer(p, wood, knob, {0.005F, w / 2 - 0.07F, -d / 2 + 0.04F, h - 0.15F, h - 0.035F});
  p.mesh.box(wood, {-w / 2 + 0.03F, -d / 2 + 0.03F, 0.16F}, {w / 2 - 0.03F, d / 2 - 0.03F, 0.178F});
}

void desk(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak());
  const MaterialId knob = p.fixed(plain("brushed_metal", {120, 120, 122}, 0.3, 6));
  four_legs(p, wood, 0.026F, 0.045F, 0.01F, 0.0F);
  // A chest of drawers under the right side, open knee room on the left.
  const float x0 = w / 2 - 0.38F, x1 = w / 2 - 0.06F;
  p.mesh.box(wood, {x0, -d / 2 + 0.05F, h - 0.50F}, {x1, d / 2 - 0.03F, h - 0.027F});
  for (int i = 0; i < 3; ++i) {
    const float z = h - 0.49F + 0.153F * static_cast<float>(i);
    drawer(p, wood, knob, {x0 + 0.008F, x1 - 0.008F, -d / 2 + 0.05F, z, z + 0.146F});
  }
  p.mesh.box(wood, {-w / 2 + 0.056F, d / 2 - 0.04F, h - 0.22F},
             {x0 - 0.001F, d / 2 - 0.025F, h - 0.027F});
}

void night_stand(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak());
  const MaterialId knob = p.fixed(plain("brushed_metal", {150, 130, 90}, 0.3, 5));
  four_legs(p, wood, 0.022F, 0.035F, 0.008F, 0.0F);
  const float z = h - 0.023F;
  p.mesh.box(wood, {-w / 2 + 0.044F, -d / 2 + 0.03F, z - 0.15F},
             {w / 2 - 0.044F, d / 2 - 0.012F, z});
  drawer(p, wood, knob, {-w / 2 + 0.05F, w / 2 - 0.05F, -d / 2 + 0.03F, z - 0.143F, z - 0.006F});
  p.mesh.box(wood, {-w / 2 + 0.012F, -d / 2 + 0.012F, 0.10F},
             {w / 2 - 0.012F, d / 2 - 0.012F, 0.118F});
}

}  // namespace mh::build
