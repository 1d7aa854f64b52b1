// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

MaterialSpec dark_plastic() {
  return plain("plastic", {36, 37, 40}, 0.2, 141);
}
MaterialSpec pale_metal() {
  return plain("brushed_metal", {178, 180, 182}, 0.3, 142);
}

/// A stack of printed sheets, slightly askew.
void paper_pile(Piece& p, const Vector3f& corner, const Vector2f& size, float tall,
                std::uint64_t key) {
  MaterialSpec print = plain("paper", {236, 234, 228}, 0.5, 600 + p.random.fork(key).below(0, 900));
  print.size_m = size;
  const MaterialId top = p.fixed(print),
                   side = p.fixed(plain("plaster", {226, 224, 218}, 0.3, 143));
  p.mesh.box(side, corner, corner + Vector3f(size.x(), size.y(), tall), {.bevel_m = 0.0F});
  p.mesh.image(top, corner + Vector3f(0, size.y(), tall + 0.0007F), {size.x(), 0, 0},
               {0, -size.y(), 0});
}

}  // namespace

void office_chair(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId cloth = p.material("fabric", plain("fabric", {52, 56, 66}, 0.4, 144));
  const MaterialId black = p.fixed(dark_plastic()), metal = p.fixed(pale_metal());
  MeshBuilder& m = p.mesh;
  const float seat = 0.46F, reach = 0.48F * std::min(w, d);
  const auto turned = static_cast<float>(p.random.uniform(2, 0.0, 6.28));
  for (int i = 0; i < 5; ++i) {  // a star of five feet on casters
    const float a = turned + 1.2566371F * static_cast<float>(i);
    const Vector3f end(reach * std::cos(a), reach * std::sin(a), 0.075F);
    m.beam(black, {0, 0, 0.11F}, end, 0.035F, 0.025F, {-std::sin(a), std::cos(a), 0});
    const Vector3f axle(-0.02F * std::sin(a), 0.02F * std::cos(a), 0);
    const Vector3f castor(0.96F * end.x(), 0.96F * end.y(), 0.03F);
    m.cylinder(black, castor - axle, castor + axle, {0.029F, 0.029F}, 12);
  }
  m.cylinder(metal, {0, 0, 0.10F}, {0, 0, seat - 0.09F}, {0.025F, 0.022F}, 12);
  m.box(black, {-0.12F, -0.10F, seat - 0.09F}, {0.12F, 0.12F, seat - 0.06F});
  m.cushion(cloth, {0, -0.02F, seat - 0.03F}, {0.80F * w, 0.78F * d, 0.075F}, 0.03F, 0.008F, 0.05F);
  m.beam(black, {0, 0.10F, seat - 0.08F}, {0, 0.44F * d, seat + 0.02F}, 0.06F, 0.02F);
  m.beam(black, {0, 0.44F * d, seat + 0.0F}, {0, 0.43F * d, seat + 0.30F}, 0.06F, 0.02F);
  const float tall = h - seat - 0.12F;
  m.push(translation(0, 0.39F * d, seat + 0.12F + 0.5F * tall) * turn(Vector3f::UnitX(), 1.45F));
  m.cushion(cloth, {0, 0, 0}, {0.76F * w, tall, 0.07F}, 0.03F, 0.006F, 0.05F);
  m.pop();
  if (p.random.uniform(5) < 0.7)  // arms
    for (const float s : {-1.0F, 1.0F}) {
      m.beam(black, {s * 0.38F * w, 0.05F, seat - 0.05F}, {s * 0.45F * w, 0.05F, seat + 0.18F},
             0.04F, 0.02F, {0, 1, 0});
      m.box(black, {s * 0.45F * w - 0.03F, -0.14F, seat + 0.18F},
            {s * 0.45F * w + 0.03F, 0.12F, seat + 0.205F}, {.bevel_m = 0.008F});
    }
}

void monitor(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId black = p.material("body", dark_plastic());
  MaterialSpec usual = plain("screen", {70, 110, 150}, 0.7, 145);
  const float z0 = 0.12F, bar = 0.012F;
  usual.size_m = {w - 2 * bar, h - z0 - 2 * bar};
  const bool on = p.random.uniform(1) < 0.6;
  const MaterialId screen = on ? p.material("screen", usual, {0.10F, 0.12F, 0.14F})
                               : p.material("screen", plain("glass", {22, 24, 28}, 0.2, 146));
  MeshBuilder& m = p.mesh;
  m.box(black, {-w / 2, -0.02F, z0}, {w / 2, 0.02F, h}, {.bevel_m = 0.004F});
  m.image(screen, {-w / 2 + bar, -0.0215F, h - bar}, {w - 2 * bar, 0, 0},
          {0, 0, -(h - z0 - 2 * bar)});
  m.beam(black, {0, 0.03F, 0.012F}, {0, 0.03F, z0 + 0.15F}, 0.05F, 0.018F);
  m.box(black, {-0.24F * w, -0.45F * d, 0}, {0.24F * w, 0.45F * d, 0.014F}, {.bevel_m = 0.005F});
}

void keyboard(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", dark_plastic());
  const MaterialId keys = p.fixed(plain("plastic", {64, 66, 70}, 0.2, 147));
  MeshBuilder& m = p.mesh;
  m.box(body, {-w / 2, -d / 2, 0}, {w / 2, d / 2, 0.7F * h}, {.bevel_m = 0.0F});
  for (int row = 0; row < 5; ++row)
    for (int k = 0; k < 15; ++k) {
      const float kw = 0.064F * w, x = -0.48F * w + kw * static_cast<float>(k), kd = 0.175F * d;
      const float y = 0.42F * d - kd * static_cast<float>(row + 1);
      m.box(keys, {x, y, 0.7F * h}, {x + 0.84F * kw, y + 0.8F * kd, h}, {.bevel_m = 0.0F});
    }
}

void filing_cabinet(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("plastic", {186, 186, 178}, 0.2, 148));
  const MaterialId grip = p.fixed(pale_metal());
  MaterialSpec label = plain("paper", {238, 236, 230}, 0.4, 149);
  label.size_m = {0.07F, 0.03F};
  MeshBuilder& m = p.mesh;
  const float y = -d / 2 + 0.04F;
  m.box(body, {-w / 2, y, 0.0F}, {w / 2, d / 2, h});
  const int n = std::max(2, static_cast<int>(std::lround(h / 0.32F)));
  const float each = (h - 0.04F) / static_cast<float>(n);
  for (int i = 0; i < n; ++i) {
    const float z0 = 0.025F + each * static_cast<float>(i), z1 = z0 + each - 0.008F;
    m.box(body, {-w / 2 + 0.008F, y - 0.016F, z0}, {w / 2 - 0.008F, y - 0.001F, z1});
    handle(p, grip, {-0.06F, y - 0.016F, z1 - 0.09F}, {0.06F, y - 0.016F, z1 - 0.09F}, 0.022F);
    m.image(p.fixed(label), {-0.035F, y - 0.0168F, z1 - 0.03F}, {0.07F, 0, 0}, {0, 0, -0.03F});
  }
}

void whiteboard(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId frame = p.material("frame", pale_metal());
  MaterialSpec usual = plain("whiteboard", {238, 240, 240}, 0.5, 150);
  usual.size_m = {w - 0.04F, h - 0.04F};
  const MaterialId face = p.material("face", usual);
  MeshBuilder& m = p.mesh;
  const float y = -d / 2 + 0.045F;
  m.box(frame, {-w / 2, y, 0}, {w / 2, d / 2, h}, {.bevel_m = 0.0F});
  m.image(face, {-w / 2 + 0.02F, y - 0.0015F, h - 0.02F}, {w - 0.04F, 0, 0}, {0, 0, -(h - 0.04F)});
  for (const float s : {-1.0F, 1.0F}) {
    m.box(frame, {s > 0 ? w / 2 - 0.02F : -w / 2, y - 0.006F, 0},
          {s > 0 ? w / 2 : -w / 2 + 0.02F, y - 0.0002F, h});
    m.box(frame, {-w / 2 + 0.02F, y - 0.006F, s > 0 ? h - 0.02F : 0.0F},
          {w / 2 - 0.02F, y - 0.0002F, s > 0 ? h : 0.02F});
  }
  m.box(frame, {-0.3F * w, -d / 2, 0.0F}, {0.3F * w, y - 0.007F, 0.012F});  // tray with pens
  constexpr std::array<Rgb8, 3> kPens = {{{190, 40, 40}, {40, 80, 170}, {30, 30, 32}}};
  for (std::size_t i = 0; i < 3; ++i) {
    const float x = -0.2F * w + 0.16F * static_cast<float>(i);
    m.cylinder(p.fixed(plain("plastic", kPens[i], 0.1, 151)), {x, -d / 2 + 0.02F, 0.02F},
               {x + 0.13F, -d / 2 + 0.022F, 0.02F}, {0.008F, 0.008F}, 8);
  }
}

void notice_board(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId frame = p.material("frame", oak());
  const MaterialId cork = p.material("face", plain("carpet", {184, 142, 96}, 0.4, 152));
  MeshBuilder& m = p.mesh;
  m.box(frame, {-w / 2, -d / 2 + 0.004F, 0}, {w / 2, d / 2, h}, {.bevel_m = 0.003F});
  m.box(cork, {-w / 2 + 0.025F, -d / 2 + 0.002F, 0.025F},
        {w / 2 - 0.025F, -d / 2 + 0.0036F, h - 0.025F}, {.bevel_m = 0.0F});
  const float area = w * h;
  const int notes = std::clamp(static_cast<int>(area * 12.0F), 3, 24);
  for (int i = 0; i < notes; ++i) {
    const RandomStream r = p.random.fork(static_cast<std::uint64_t>(200 + i));
    const float nw = static_cast<float>(r.uniform(0, 0.09, 0.22)),
                nh = nw * static_cast<float>(r.uniform(1, 1.0, 1.45));
    if (nw > w - 0.08F || nh > h - 0.08F) continue;
    const auto x = static_cast<float>(r.uniform(2, -w / 2 + 0.03, w / 2 - 0.03 - nw));
    const auto z = static_cast<float>(r.uniform(3, 0.03 + nh, h - 0.03));
    constexpr std::array<Rgb8, 4> kTones = {
        {{236, 234, 228}, {240, 226, 150}, {196, 220, 236}, {232, 190, 190}}};
    MaterialSpec print = plain(r.uniform(4) < 0.25 ? "poster" : "paper", kTones[r.below(5, 4)], 0.6,
                               700 + r.below(6, 4000));
    print.size_m = {nw, nh};
    const float y = -d / 2 + 0.0015F - 0.0004F * static_cast<float>(i % 4);
    m.image(p.fixed(print), {x, y, z}, {nw, 0, 0}, {0, 0, -nh});
    m.cylinder(p.fixed(plain("plastic", {190, 50, 44}, 0.1)), {x + nw / 2, y, z - 0.012F},
               {x + nw / 2, -d / 2 + 0.0F, z - 0.012F}, {0.005F, 0.006F}, 8);
  }
}

void copier(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId pale = p.material("body", plain("plastic", {214, 214, 208}, 0.2, 153));
  const MaterialId gray = p.fixed(plain("plastic", {116, 120, 126}, 0.2, 154));
  const MaterialId black = p.fixed(dark_plastic());
  MeshBuilder& m = p.mesh;
  const float y = -d / 2 + 0.10F, x0 = -w / 2 + 0.10F, x1 = w / 2 - 0.16F;
  m.box(black, {x0 + 0.03F, y + 0.03F, 0}, {x1 - 0.03F, d / 2 - 0.03F, 0.04F});
  m.box(pale, {x0, y, 0.04F}, {x1, d / 2, 0.60F * h}, {.bevel_m = 0.01F});
  for (int i = 0; i < 4; ++i) {  // paper drawers
    const float z = 0.06F + 0.125F * h * static_cast<float>(i);
    m.box(i == 3 ? gray : pale, {x0 + 0.01F, y - 0.014F, z},
          {x1 - 0.01F, y - 0.001F, z + 0.115F * h});
    m.box(gray, {-0.10F, y - 0.016F, z + 0.07F * h}, {0.06F, y - 0.013F, z + 0.095F * h},
          {.bevel_m = 0.0F});
  }
  // The open slot where copies come out, the scanner above it, the feeder on top.
  m.box(gray, {x0 + 0.02F, d / 2 - 0.12F, 0.60F * h}, {x1, d / 2, 0.74F * h});
  m.box(pale, {x0, y, 0.60F * h}, {x0 + 0.06F, d / 2 - 0.121F, 0.74F * h});
  m.box(gray, {x0 + 0.061F, y + 0.02F, 0.60F * h}, {x1 - 0.02F, d / 2 - 0.121F, 0.605F * h});
  paper_pile(p, {x0 + 0.12F, y + 0.08F, 0.607F * h}, {0.22F, 0.30F}, 0.012F, 7);
  m.box(pale, {x0, y - 0.02F, 0.74F * h}, {x1, d / 2, 0.86F * h}, {.bevel_m = 0.012F});
  m.box(pale, {x0 + 0.01F, y + 0.06F, 0.862F * h}, {x1 - 0.02F, d / 2 - 0.01F, 0.95F * h},
        {.bevel_m = 0.02F});
  m.push(translation(x0 + 0.14F, 0, 0.955F * h) * turn(Vector3f::UnitY(), -0.12F));
  m.box(gray, {-0.02F, y + 0.12F, 0}, {0.30F, d / 2 - 0.06F, 0.008F});
  m.pop();
  // Touch panel, side tray.
  MaterialSpec panel = plain("screen", {90, 140, 180}, 0.7, 155);
  panel.size_m = {0.20F, 0.12F};
  m.push(translation(0.5F * (x0 + x1) + 0.04F, y - 0.03F, 0.83F * h) *
         turn(Vector3f::UnitX(), -0.7F));
  m.box(gray, {-0.15F, -0.09F, -0.02F}, {0.15F, 0.09F, 0}, {.bevel_m = 0.006F});
  m.image(p.fixed(panel, {0.12F, 0.14F, 0.16F}), {-0.13F, 0.06F, 0.0008F}, {0.20F, 0, 0},
          {0, -0.12F, 0});
  m.pop();
  m.push(translation(x1, 0.05F, 0.45F * h) * turn(Vector3f::UnitY(), -0.5F));
  m.box(pale, {0, -0.16F, 0}, {0.17F, 0.16F, 0.012F});
  m.pop();
}

void printer(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("plastic", {208, 208, 204}, 0.2, 156));
  const MaterialId black = p.fixed(dark_plastic());
  MeshBuilder& m = p.mesh;
  m.box(body, {-w / 2, -d / 2 + 0.05F, 0}, {w / 2, d / 2, 0.62F * h}, {.bevel_m = 0.012F});
  m.box(body, {-w / 2, 0.0F, 0.62F * h}, {w / 2, d / 2, 0.92F * h}, {.bevel_m = 0.012F});
  m.box(black, {-0.36F * w, -d / 2 + 0.045F, 0.30F * h}, {0.36F * w, -d / 2 + 0.052F, 0.5F * h},
        {.bevel_m = 0.0F});
  m.box(black, {-0.3F * w, -d / 2 + 0.0F, 0.28F * h}, {0.3F * w, -d / 2 + 0.05F, 0.30F * h},
        {.bevel_m = 0.0F});
  paper_pile(p, {-0.3F * w, -d / 2 + 0.07F, 0.622F * h}, {0.6F * w, 0.38F * d}, 0.008F, 3);
  m.box(black, {0.2F * w, -0.008F, 0.68F * h}, {0.44F * w, 0.0005F, 0.86F * h}, {.bevel_m = 0.0F});
}

void paper_stack(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const int sheets = std::max(1, static_cast<int>(h / 0.02F));
  const float each = h / static_cast<float>(sheets);
  for (int i = 0; i < sheets; ++i) {
    const RandomStream r = p.random.fork(static_cast<std::uint64_t>(i));
    p.mesh.push(turn_z(static_cast<float>(r.uniform(0, -0.12, 0.12))));
    paper_pile(p, {-0.46F * w, -0.46F * d, each * static_cast<float>(i)}, {0.92F * w, 0.92F * d},
               each - 0.0012F, 40 + static_cast<std::uint64_t>(i));
    p.mesh.pop();
  }
}

void mailboxes(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak());
  MeshBuilder& m = p.mesh;
  const int columns = std::max(2, static_cast<int>(w / 0.28F)),
            rows = std::max(3, static_cast<int>((h - 0.1F) / 0.12F));
  const float cw = w / static_cast<float>(columns), ch = h / static_cast<float>(rows), t = 0.012F;
  m.box(wood, {-w / 2, d / 2 - 0.012F, 0}, {w / 2, d / 2, h}, {.bevel_m = 0.0F});
  for (int i = 0; i <= columns; ++i) {
    const float x = std::clamp(-w / 2 + cw * static_cast<float>(i) - t / 2, -w / 2, w / 2 - t);
    m.box(wood, {x, -d / 2, 0}, {x + t, d / 2 - 0.0125F, h}, {.bevel_m = 0.0F, .grain_axis = 2});
  }
  MaterialSpec label = plain("paper", {240, 238, 230}, 0.5, 157);
  label.size_m = {0.09F, 0.018F};
  for (int j = 0; j <= rows; ++j) {
    const float z = std::clamp(ch * static_cast<float>(j) - t / 2, 0.0F, h - t);
    for (int i = 0; i < columns; ++i) {
      const float x = -w / 2 + cw * static_cast<float>(i);
      m.box(wood, {x + t / 2 + 0.0005F, -d / 2 + 0.003F, z},
            {x + cw - t / 2 - 0.0005F, d / 2 - 0.0125F, z + t}, {.bevel_m = 0.0F, .grain_axis = 0});
      if (j == rows) continue;
      m.image(p.fixed(label), {x + 0.5F * cw - 0.045F, -d / 2 + 0.0022F, z + t + 0.002F},
              {0.09F, 0, 0}, {0, 0, -0.016F});
      const RandomStream r = p.random.fork(static_cast<std::uint64_t>(100 * j + i));
      if (r.uniform(0) < 0.62)
        paper_pile(
            p,
            {x + t, -d / 2 + 0.03F + static_cast<float>(r.uniform(1, 0.0, 0.05)), z + t + 0.0005F},
            {cw - 2 * t - 0.01F, std::min(0.30F, d - 0.1F)},
            static_cast<float>(r.uniform(2, 0.004, 0.6 * (ch - 2 * t))),
            static_cast<std::uint64_t>(r.below(3, 6)));
    }
  }
}

void conference_table(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak()), metal = p.material("metal", pale_metal());
  MeshBuilder& m = p.mesh;
  // A boat-shaped or oval top on two broad feet.
  std::vector<Vector2f> outline;
  const float square = p.random.uniform(1) < 0.5 ? 0.35F : 0.7F;
  for (int i = 0; i < 48; ++i) {
    const float a = 6.2831853F * static_cast<float>(i) / 48.0F, c = std::cos(a), s = std::sin(a);
    outline.emplace_back(0.5F * w * std::copysign(std::pow(std::abs(c), square), c),
                         0.5F * d * std::copysign(std::pow(std::abs(s), square), s));
  }
  m.prism(wood, outline, h - 0.035F, h);
  const int feet = w > 3.0F ? 3 : 2;
  for (int i = 0; i < feet; ++i) {
    const float x = (static_cast<float>(i) - 0.5F * static_cast<float>(feet - 1)) * 0.6F * w /
                    static_cast<float>(feet - 1);
    m.box(metal, {x - 0.06F, -0.30F * d, 0}, {x + 0.06F, 0.30F * d, 0.03F}, {.bevel_m = 0.008F});
    m.box(wood, {x - 0.03F, -0.20F * d, 0.03F}, {x + 0.03F, 0.20F * d, h - 0.036F},
          {.grain_axis = 2});
  }
  m.box(p.fixed(dark_plastic()), {-0.14F, -0.05F, h - 0.002F}, {0.14F, 0.05F, h + 0.0F},
        {.bevel_m = 0.0F});
}

void conference_phone(Piece& p) {
  const float r = 0.5F * p.size_m.x(), h = p.size_m.z();
  const MaterialId black = p.fixed(dark_plastic()),
                   pale = p.fixed(plain("plastic", {150, 154, 158}, 0.1, 158));
  for (int i = 0; i < 3; ++i) {
    const float a = 2.0944F * static_cast<float>(i);
    p.mesh.push(turn_z(a));
    p.mesh.cushion(black, {0.52F * r, 0, 0.45F * h}, {0.9F * r, 0.42F * r, 0.7F * h}, 0.12F * r,
                   0.0F, 0.04F);
    p.mesh.pop();
  }
  p.mesh.cylinder(pale, {0, 0, 0.2F * h}, {0, 0, h}, {0.34F * r, 0.22F * r}, 16);
}

void water_cooler(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("plastic", {226, 228, 230}, 0.1, 159));
  const MaterialId water = p.fixed(plain("glass", {112, 164, 206}, 0.2, 160)),
                   black = p.fixed(dark_plastic());
  MeshBuilder& m = p.mesh;
  const float top = 0.72F * h;
  m.box(body, {-w / 2, -d / 2 + 0.02F, 0}, {w / 2, d / 2, top}, {.bevel_m = 0.02F});
  m.box(black, {-0.36F * w, -d / 2 + 0.015F, 0.72F * top},
        {0.36F * w, -d / 2 + 0.021F, 0.92F * top}, {.bevel_m = 0.0F});
  m.box(body, {-0.34F * w, -d / 2, 0.70F * top}, {0.34F * w, -d / 2 + 0.02F, 0.72F * top});
  const std::array<Rgb8, 2> tones = {{{60, 110, 190}, {190, 60, 54}}};
  for (std::size_t i = 0; i < 2; ++i)
    m.cylinder(p.fixed(plain("plastic", tones[i], 0.1)),
               {(i == 0 ? -0.14F : 0.14F) * w, -d / 2 + 0.004F, 0.83F * top},
               {(i == 0 ? -0.14F : 0.14F) * w, -d / 2 + 0.02F, 0.83F * top}, {0.016F, 0.016F}, 10);
  const float r = 0.44F * std::min(w, d);
  m.lathe(water, {0, 0.0F, top},
          std::array<Vector2f, 8>{{{0.3F * r, 0},
                                   {0.35F * r, 0.03F},
                                   {0.95F * r, 0.09F},
                                   {r, 0.12F},
                                   {r, 0.2F},
                                   {0.96F * r, 0.22F},
                                   {r, 0.24F},
                                   {r, h - top - 0.02F}}},
          24);
  m.lathe(water, {0, 0.0F, top},
          std::array<Vector2f, 3>{{{r, h - top - 0.02F}, {0.9F * r, h - top}, {0.001F, h - top}}},
          24);
}

void computer(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", dark_plastic()), pale = p.fixed(pale_metal());
  MeshBuilder& m = p.mesh;
  m.box(body, {-w / 2, -d / 2 + 0.01F, 0}, {w / 2, d / 2, h}, {.bevel_m = 0.006F});
  m.box(pale, {-0.42F * w, -d / 2 + 0.004F, 0.78F * h}, {0.42F * w, -d / 2 + 0.012F, 0.84F * h},
        {.bevel_m = 0.0F});
  for (int i = 0; i < 6; ++i)
    m.box(pale, {-0.36F * w, -d / 2 + 0.006F, 0.15F * h + 0.03F * static_cast<float>(i)},
          {0.36F * w, -d / 2 + 0.011F, 0.15F * h + 0.03F * static_cast<float>(i) + 0.008F},
          {.bevel_m = 0.0F});
}

void panel_lamp(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId rim = p.material("rim", plain("plastic", {220, 220, 216}, 0.1, 162));
  const MaterialId glow = p.fixed(plain("ceramic", {12, 12, 12}, 0.05, 92), {1.1F, 1.05F, 0.98F});
  MeshBuilder& m = p.mesh;
  const float bar = 0.02F;
  for (const float s : {-1.0F, 1.0F}) {
    m.box(rim, {s > 0 ? w / 2 - bar : -w / 2, -d / 2, 0}, {s > 0 ? w / 2 : -w / 2 + bar, d / 2, h},
          {.bevel_m = 0.0F});
    m.box(rim, {-w / 2 + bar, s > 0 ? d / 2 - bar : -d / 2, 0},
          {w / 2 - bar, s > 0 ? d / 2 : -d / 2 + bar, h}, {.bevel_m = 0.0F});
  }
  m.box(glow, {-w / 2 + bar, -d / 2 + bar, 0.3F * h}, {w / 2 - bar, d / 2 - bar, h},
        {.bevel_m = 0.0F});
}

}  // namespace mh::build
