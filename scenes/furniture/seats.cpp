// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector3f;

void bed(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak());
  const MaterialId linen = p.material("linen", plain("fabric", {226, 222, 214}, 0.3, 37));
  const MaterialId duvet = p.material("duvet", plain("fabric", {132, 152, 178}, 0.5, 38));
  MeshBuilder& m = p.mesh;
  const float x = w / 2, back = d / 2, front = -d / 2;
  for (const float sx : {-1.0F, 1.0F})  // legs
    for (const float y : {front + 0.05F, back - 0.05F})
      m.box(wood, {sx * (x - 0.05F) - 0.04F, y - 0.04F, 0},
            {sx * (x - 0.05F) + 0.04F, y + 0.04F, 0.14F});
  m.box(wood, {-x, front, 0.14F}, {-x + 0.035F, back - 0.04F, 0.32F});  // side rails
  m.box(wood, {x - 0.035F, front, 0.14F}, {x, back - 0.04F, 0.32F});
  m.box(wood, {-x + 0.036F, front, 0.14F}, {x - 0.036F, front + 0.035F, 0.32F});
  m.box(wood, {-x + 0.036F, front + 0.036F, 0.18F}, {x - 0.036F, back - 0.04F, 0.22F});  // slats
  m.box(wood, {-x, back - 0.045F, 0.14F}, {x, back, h - 0.05F});  // headboard with a cap
  m.box(wood, {-x, back - 0.06F, h - 0.05F}, {x, back, h}, {.bevel_m = 0.008F});
  m.cushion(linen, {0, -0.02F, 0.33F}, {w - 0.09F, d - 0.11F, 0.22F}, 0.05F, 0.005F);  // mattress
  // Duvet: a thick soft sheet that hangs over the sides and is folded back below the pillows.
  const float top = back - 0.62F, thick = 0.05F;
  const auto cover = [&](float s, float t) -> Vector3f {
    const float across = (2.0F * s - 1.0F) * (x + 0.16F);
    const float inside = x - 0.005F;
    float px = std::clamp(across, -inside, inside);
    float fall = std::max(0.0F, std::abs(across) - inside);
    const float y = front + 0.015F + t * (top - front - 0.015F);
    const float ripple =
        0.010F * std::sin(9.0F * y + 3.0F * across) + 0.008F * std::sin(15.0F * across + 4.0F * y);
    const float edge = std::min(1.0F, fall / 0.05F);
    px -= (px > 0 ? 1.0F : -1.0F) * 0.004F * edge * (1.0F + std::sin(22.0F * y));
    return {px, y, 0.455F + thick * (1.0F - 0.6F * edge) - fall + ripple * (1.0F - edge)};
  };
  m.sheet(duvet, [&](float s, float t) { return cover(s, 1.0F - t); }, 34, 24,
          {w + 0.3F, d - 0.6F});
  m.cushion(duvet, {0, top - 0.02F, 0.485F}, {w - 0.03F, 0.22F, 0.085F}, 0.04F);  // the fold
  m.sheet(duvet,
          [&](float s, float t) {  // over the foot of the bed
            Vector3f q = cover(s, 0.0F);
            q.z() -= t * std::max(0.0F, q.z() - 0.30F);
            return q;
          },
          34, 4, {w + 0.3F, 0.2F});
  for (int i = 0; i < 2; ++i) {
    p.part(fmt::format("pillow_{}", i + 1), "pillow");
    m.push(translation((i == 0 ? -0.25F : 0.25F) * w, back - 0.27F, 0.50F) *
           turn_z(i == 0 ? 0.06F : -0.05F) * turn(Vector3f::UnitX(), 0.22F));
    m.cushion(linen, {0, 0, 0}, {0.44F * w, 0.36F, 0.11F}, 0.045F, 0.03F);
    m.pop();
  }
  p.body();
}

namespace {

/// Seat with arms for `seats` persons.
void upholstered(Piece& p, int seats) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId fabric = p.material("fabric", plain("fabric", {118, 122, 126}, 0.5, 31));
  const MaterialId wood = p.material("wood", plain("wood_grain", {122, 84, 54}, 0.5, 16));
  MeshBuilder& m = p.mesh;
  const float x = w / 2, y = d / 2, arm = seats > 1 ? 0.17F : 0.13F, back = 0.20F, seat = 0.43F;
  for (const float sx : {-1.0F, 1.0F})
    for (const float sy : {-1.0F, 1.0F})
      m.cylinder(wood, {sx * (x - 0.07F), sy * (y - 0.07F), 0},
                 {sx * (x - 0.08F), sy * (y - 0.08F), 0.13F}, {0.018F, 0.028F}, 10);
  m.cushion(fabric, {0, 0, 0.205F}, {w - 0.02F, d - 0.03F, 0.17F}, 0.03F);  // base
  for (const float sx : {-1.0F, 1.0F})
    m.cushion(fabric, {sx * (x - arm / 2), -0.01F, 0.36F}, {arm, d - 0.02F, 0.48F}, 0.06F);
  m.cushion(fabric, {0, y - back / 2, 0.5F * (0.15F + h)}, {w - 0.02F, back, h - 0.15F}, 0.07F);
  const float inner = w - 2 * arm, each = inner / static_cast<float>(seats);
  for (int i = 0; i < seats; ++i) {
    const float cx = -inner / 2 + (static_cast<float>(i) + 0.5F) * each;
    m.cushion(fabric, {cx, -0.5F * back - 0.005F, 0.36F}, {each - 0.008F, d - back - 0.01F, 0.15F},
              0.045F, 0.015F);
    m.push(translation(cx, y - back - 0.055F, seat + 0.19F) * turn(Vector3f::UnitX(), -0.18F));
    m.cushion(fabric, {0, 0, 0}, {each - 0.012F, 0.14F, 0.38F}, 0.06F);
    m.pop();
  }
}

}  // namespace

void sofa(Piece& p) {
  upholstered(p, p.size_m.x() > 2.0F ? 3 : 2);
}
void armchair(Piece& p) {
  upholstered(p, 1);
}

void chair(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak());
  MeshBuilder& m = p.mesh;
  const float x = w / 2 - 0.022F, y = d / 2, seat = 0.44F;
  const float lean = 0.05F;  // how far the back leans
  for (const float sx : {-1.0F, 1.0F}) {
    m.beam(wood, {sx * x, -y + 0.03F, 0}, {sx * x, -y + 0.03F, seat - 0.02F}, 0.036F, 0.036F);
    m.beam(wood, {sx * x, y - lean, 0}, {sx * x, y - lean, seat}, 0.036F, 0.036F);
    m.beam(wood, {sx * x, y - lean, seat}, {sx * x, y - 0.017F, h - 0.012F}, 0.036F, 0.034F);
    m.beam(wood, {sx * x, -y + 0.05F, 0.20F}, {sx * x, y - lean - 0.02F, 0.20F}, 0.018F, 0.028F);
    m.box(wood, {sx * x - 0.011F, -y + 0.05F, seat - 0.075F},
          {sx * x + 0.011F, y - lean - 0.02F, seat - 0.022F});
  }
  m.box(wood, {-x + 0.019F, -y + 0.02F, seat - 0.075F}, {x - 0.019F, -y + 0.04F, seat - 0.022F});
  m.box(wood, {-x + 0.019F, y - lean - 0.01F, seat - 0.075F},
        {x - 0.019F, y - lean + 0.01F, seat - 0.022F});
  m.box(wood, {-x + 0.019F, y - lean - 0.008F, 0.20F}, {x - 0.019F, y - lean + 0.008F, 0.23F});
  // Seat: a shallow board between the back posts.
  m.box(wood, {-w / 2, -y, seat - 0.02F}, {w / 2, y - lean - 0.02F, seat},
        {.bevel_m = 0.008F, .grain_axis = 1});
  // Back: a top rail, a lower rail and upright slats between.
  const auto lean_y = [&](float z) {
    return y - lean + (lean - 0.017F) * (z - seat) / (h - 0.012F - seat);
  };
  const float low = seat + 0.13F, high = h - 0.085F;
  m.beam(wood, {-x + 0.017F, lean_y(h - 0.05F), h - 0.05F},
         {x - 0.017F, lean_y(h - 0.05F), h - 0.05F}, 0.075F, 0.022F, {0, 0, 1});
  m.beam(wood, {-x + 0.017F, lean_y(low), low}, {x - 0.017F, lean_y(low), low}, 0.035F, 0.018F,
         {0, 0, 1});
  for (int i = 0; i < 5; ++i) {
    const float sx = (static_cast<float>(i) - 2.0F) * (2 * x - 0.06F) / 5.0F;
    m.beam(wood, {sx, lean_y(low + 0.016F), low + 0.016F}, {sx, lean_y(high), high}, 0.026F,
           0.012F);
  }
}

void bench(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak());
  MeshBuilder& m = p.mesh;
  for (int i = 0; i < 3; ++i) {  // three planks
    const float each = (d - 0.02F) / 3.0F, y = -d / 2 + static_cast<float>(i) * (each + 0.01F);
    m.box(wood, {-w / 2, y, h - 0.03F}, {w / 2, y + each, h}, {.bevel_m = 0.006F});
  }
  for (const float sx : {-1.0F, 1.0F}) {
    const float x = sx * (w / 2 - 0.11F);
    m.box(wood, {x - 0.025F, -d / 2 + 0.03F, 0}, {x + 0.025F, -d / 2 + 0.08F, h - 0.031F});
    m.box(wood, {x - 0.025F, d / 2 - 0.08F, 0}, {x + 0.025F, d / 2 - 0.03F, h - 0.031F});
    m.box(wood, {x - 0.02F, -d / 2 + 0.081F, h - 0.10F}, {x + 0.02F, d / 2 - 0.081F, h - 0.031F});
  }
  m.box(wood, {-w / 2 + 0.136F, -0.015F, h - 0.09F}, {w / 2 - 0.136F, 0.015F, h - 0.04F});
}

void pillow(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId fabric = p.material("fabric", plain("knit", {196, 152, 62}, 0.6, 33));
  // Leaning back against whatever is behind it.
  p.mesh.push(translation(0, 0, h / 2) * turn(Vector3f::UnitX(), 1.57079633F - 0.24F));
  p.mesh.cushion(fabric, {0, 0, 0}, {w, h - 0.02F, 0.45F * d}, 0.22F * d, 0.16F * d, 0.05F);
  p.mesh.pop();
}

void teddy_bear(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId fur = p.material("fur", plain("carpet", {164, 116, 72}, 0.5, 81));
  const MaterialId pale = p.fixed(plain("carpet", {206, 172, 128}, 0.4, 82));
  const MaterialId black = p.fixed(plain("plastic", {24, 20, 20}, 0.1));
  MeshBuilder& m = p.mesh;
  const auto ball = [&](MaterialId material, Vector3f c, Vector3f size) {
    m.cushion(material, c, size, 0.5F * size.minCoeff(), 0.0F, 0.06F);
  };
  ball(fur, {0, 0.02F, 0.26F * h}, {0.56F * w, 0.55F * d, 0.50F * h});
  ball(pale, {0, -0.05F * d, 0.26F * h}, {0.40F * w, 0.52F * d, 0.38F * h});
  ball(fur, {0, 0.02F, 0.66F * h}, {0.56F * w, 0.56F * d, 0.36F * h});
  ball(pale, {0, -0.22F * d, 0.61F * h}, {0.26F * w, 0.26F * d, 0.15F * h});
  ball(black, {0, -0.35F * d, 0.645F * h}, {0.08F * w, 0.05F * d, 0.04F * h});
  for (const float sx : {-1.0F, 1.0F}) {
    ball(fur, {sx * 0.22F * w, 0.03F, 0.86F * h}, {0.20F * w, 0.14F * d, 0.15F * h});
    ball(fur, {sx * 0.36F * w, -0.06F * d, 0.36F * h}, {0.20F * w, 0.30F * d, 0.30F * h});
    ball(fur, {sx * 0.27F * w, -0.30F * d, 0.11F * h}, {0.26F * w, 0.38F * d, 0.21F * h});
    ball(black, {sx * 0.11F * w, -0.245F * d, 0.70F * h}, {0.055F * w, 0.05F * d, 0.04F * h});
  }
}

}  // namespace mh::build
