// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

MaterialSpec porcelain() {
  return plain("ceramic", {232, 232, 228}, 0.1, 61);
}
MaterialSpec tap_chrome() {
  return plain("brushed_metal", {196, 198, 200}, 0.2, 62);
}

/// A tap: a post, a spout that bends forward, a lever; its foot at `foot`, facing -y.
void tap(Piece& p, const Vector3f& foot, float tall) {
  const MaterialId metal = p.fixed(tap_chrome());
  MeshBuilder& m = p.mesh;
  m.cylinder(metal, foot, foot + Vector3f(0, 0, tall), {0.018F, 0.016F}, 12);
  const std::array<Vector3f, 4> spout = {
      foot + Vector3f(0, 0, 0.8F * tall), foot + Vector3f(0, -0.05F, 1.0F * tall),
      foot + Vector3f(0, -0.10F, 0.95F * tall), foot + Vector3f(0, -0.115F, 0.78F * tall)};
  m.tube(metal, spout, 0.010F, 10);
  m.cylinder(metal, foot + Vector3f(0, 0, tall), foot + Vector3f(0.03F, 0.02F, tall + 0.05F),
             {0.007F, 0.006F}, 8);
}

}  // namespace

void toilet(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId white = p.material("body", porcelain());
  const MaterialId seat = p.material("seat", plain("plastic", {238, 238, 236}, 0.1, 63));
  const MaterialId metal = p.fixed(tap_chrome());
  MeshBuilder& m = p.mesh;
  const float rim = 0.40F, tank = 0.19F;
  // Tank with its lid and button.
  m.box(white, {-w / 2 + 0.01F, d / 2 - tank, rim - 0.02F}, {w / 2 - 0.01F, d / 2, h - 0.035F},
        {.bevel_m = 0.02F});
  m.box(white, {-w / 2, d / 2 - tank - 0.01F, h - 0.034F}, {w / 2, d / 2, h}, {.bevel_m = 0.012F});
  m.cylinder(metal, {0, d / 2 - 0.09F, h - 0.002F}, {0, d / 2 - 0.09F, h + 0.0F}, {0.025F, 0.025F},
             16);
  // Bowl on a waisted foot.
  const float length = d - tank, cy = -d / 2 + 0.5F * length, rx = 0.5F * w - 0.01F,
              ry = 0.5F * length;
  const std::array<Vector2f, 9> bowl = {{{0.62F, 0.0F},
                                         {0.60F, 0.04F},
                                         {0.55F, 0.12F},
                                         {0.60F, 0.22F},
                                         {0.86F, 0.33F},
                                         {0.98F, rim - 0.02F},
                                         {0.97F, rim},
                                         {0.74F, rim},
                                         {0.50F, 0.27F}}};
  oval(p, white, {0, cy, 0}, {rx, ry, 0.8F}, bowl, 28);
  m.box(white, {-0.6F * rx, cy, 0.0F}, {0.6F * rx, d / 2 - 0.02F, rim - 0.03F}, {.bevel_m = 0.03F});
  m.cylinder(p.fixed(plain("glass", {150, 170, 178}, 0.1, 64)), {0, cy, 0.26F}, {0, cy, 0.275F},
             {0.45F * rx, 0.47F * rx}, 20);
  // Seat, and the lid: closed, or leaning against the tank.
  const std::array<Vector2f, 5> ring = {{{0.72F, rim + 0.002F},
                                         {1.0F, rim + 0.002F},
                                         {1.0F, rim + 0.018F},
                                         {0.72F, rim + 0.020F},
                                         {0.72F, rim + 0.002F}}};
  oval(p, seat, {0, cy, 0}, {rx, ry, 0.8F}, ring, 28);
  const std::array<Vector2f, 4> disc = {
      {{0.99F, 0}, {1.0F, 0.012F}, {0.9F, 0.018F}, {0.01F, 0.02F}}};
  if (p.random.uniform(3) < 0.5) {
    oval(p, seat, {0, cy, rim + 0.021F}, {rx, ry, 0.8F}, disc, 28);
  } else {
    m.push(translation(0, d / 2 - tank - 0.025F, rim + 0.02F) * turn(Vector3f::UnitX(), 1.42F));
    oval(p, seat, {0, -0.9F * ry, 0}, {rx, 0.9F * ry, 0.8F}, disc, 28);
    m.pop();
  }
}

void bathtub(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId white = p.material("body", porcelain()), metal = p.fixed(tap_chrome());
  MeshBuilder& m = p.mesh;
  const float lip = 0.07F;
  // An apron in front and at the ends, a rim, and the inside as one rounded basin.
  m.box(white, {-w / 2, -d / 2, 0}, {w / 2, -d / 2 + 0.03F, h - 0.03F}, {.bevel_m = 0.006F});
  m.box(white, {-w / 2, d / 2 - 0.03F, 0}, {w / 2, d / 2, h - 0.03F});
  m.box(white, {-w / 2, -d / 2 + 0.031F, 0}, {-w / 2 + 0.03F, d / 2 - 0.031F, h - 0.03F});
  m.box(white, {w / 2 - 0.03F, -d / 2 + 0.031F, 0}, {w / 2, d / 2 - 0.031F, h - 0.03F});
  m.box(white, {-w / 2, -d / 2, h - 0.03F}, {w / 2, -d / 2 + lip, h}, {.bevel_m = 0.012F});
  m.box(white, {-w / 2, d / 2 - lip, h - 0.03F}, {w / 2, d / 2, h}, {.bevel_m = 0.012F});
  m.box(white, {-w / 2, -d / 2 + lip, h - 0.03F}, {-w / 2 + 1.6F * lip, d / 2 - lip, h},
        {.bevel_m = 0.012F});
  m.box(white, {w / 2 - 1.4F * lip, -d / 2 + lip, h - 0.03F}, {w / 2, d / 2 - lip, h},
        {.bevel_m = 0.012F});
  const float x0 = -w / 2 + 1.5F * lip, x1 = w / 2 - 1.3F * lip;
  const std::array<Vector2f, 7> hollow = {{{1.03F, h - 0.004F},
                                           {1.0F, h - 0.03F},
                                           {0.95F, 0.6F * h},
                                           {0.90F, 0.35F * h},
                                           {0.82F, 0.22F * h},
                                           {0.6F, 0.18F * h},
                                           {0.01F, 0.17F * h}}};
  oval(p, white, {0.5F * (x0 + x1), 0, 0}, {0.5F * (x1 - x0), 0.5F * d - 0.9F * lip, 0.45F}, hollow,
       40);
  // Mixer and drain at one end.
  const float tx = w / 2 - 0.035F;
  m.cylinder(metal, {tx, -0.07F, h}, {tx, -0.07F, h + 0.09F}, {0.016F, 0.016F}, 10);
  m.cylinder(metal, {tx, 0.07F, h}, {tx, 0.07F, h + 0.09F}, {0.016F, 0.016F}, 10);
  m.cylinder(metal, {tx, -0.10F, h + 0.09F}, {tx, 0.10F, h + 0.09F}, {0.018F, 0.018F}, 12);
  const std::array<Vector3f, 3> spout = {
      {{tx, 0, h + 0.09F}, {tx - 0.09F, 0, h + 0.085F}, {tx - 0.12F, 0, h + 0.06F}}};
  m.tube(metal, spout, 0.013F, 10);
}

void shower(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId white = p.material("body", porcelain()), metal = p.fixed(tap_chrome());
  const MaterialId wall = p.material("wall", plain("tiles", {214, 222, 224}, 0.2, 65));
  MeshBuilder& m = p.mesh;
  // Tray, tiled back and side, a framed half-height screen on the other side, rail and shower head.
  m.box(white, {-w / 2, -d / 2, 0}, {w / 2, d / 2, 0.05F}, {.bevel_m = 0.01F});
  for (const float s : {-1.0F, 1.0F}) {
    m.box(white, {-w / 2, s > 0 ? d / 2 - 0.05F : -d / 2, 0.05F},
          {w / 2, s > 0 ? d / 2 : -d / 2 + 0.05F, 0.12F}, {.bevel_m = 0.01F});
    m.box(white, {s > 0 ? w / 2 - 0.05F : -w / 2, -d / 2 + 0.05F, 0.05F},
          {s > 0 ? w / 2 : -w / 2 + 0.05F, d / 2 - 0.05F, 0.12F}, {.bevel_m = 0.01F});
  }
  m.box(wall, {-w / 2, d / 2 - 0.02F, 0.12F}, {w / 2, d / 2, h}, {.bevel_m = 0.0F});
  m.box(wall, {w / 2 - 0.02F, -d / 2, 0.12F}, {w / 2, d / 2 - 0.021F, h}, {.bevel_m = 0.0F});
  for (const float x : {-w / 2 + 0.012F, w / 2 - 0.034F})
    m.box(metal, {x - 0.012F, -d / 2 + 0.0F, 0.12F}, {x + 0.012F, -d / 2 + 0.024F, h});
  m.box(metal, {-w / 2, -d / 2, h - 0.03F}, {w / 2 - 0.021F, -d / 2 + 0.024F, h});
  m.box(metal, {-w / 2, -d / 2 + 0.025F, h - 0.03F}, {-w / 2 + 0.024F, d / 2 - 0.021F, h});
  const float rx = 0.15F * w, ry = d / 2 - 0.05F;
  m.cylinder(metal, {rx, ry, 0.95F}, {rx, ry, std::min(h - 0.06F, 1.95F)}, {0.010F, 0.010F}, 10);
  m.cylinder(metal, {rx, ry - 0.09F, std::min(h - 0.1F, 1.90F)},
             {rx, ry - 0.11F, std::min(h - 0.13F, 1.86F)}, {0.03F, 0.055F}, 16);
  m.cylinder(metal, {rx, ry, std::min(h - 0.08F, 1.92F)},
             {rx, ry - 0.09F, std::min(h - 0.1F, 1.90F)}, {0.009F, 0.009F}, 8);
  m.cylinder(metal, {rx - 0.09F, ry + 0.005F, 1.02F}, {rx + 0.09F, ry + 0.005F, 1.02F},
             {0.02F, 0.02F}, 12);
  std::vector<Vector3f> hose;
  for (int i = 0; i <= 12; ++i) {
    const float t = static_cast<float>(i) / 12.0F;
    hose.emplace_back(rx + 0.10F * std::sin(3.14F * t), ry - 0.02F - 0.05F * t,
                      1.0F - 0.35F * std::sin(3.14F * t) + 0.85F * t * t);
  }
  m.tube(metal, hose, 0.006F, 6);
  m.cylinder(metal, {0, 0, 0.05F}, {0, 0, 0.054F}, {0.045F, 0.045F}, 16);
  p.part("curtain", "shower curtain");
  const MaterialId cloth = p.material("fabric", plain("curtain_fabric", {196, 210, 214}, 0.4, 66));
  const float cw = 0.55F * w, ch = h - 0.2F;
  m.sheet(cloth,
          [&](float s, float t) -> Vector3f {
            const float a = 6.2831853F * 6.0F * s;
            return {-w / 2 + 0.03F + cw * s,
                    -d / 2 + 0.035F + 0.02F * (0.6F + 0.4F * t) * std::sin(a), h - 0.035F - t * ch};
          },
          60, 20, {1.4F * cw, ch});
  p.body();
}

void washbasin(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId white = p.material("body", porcelain());
  const MaterialId wood = p.material("wood", plain("plastic", {226, 226, 222}, 0.1, 67));
  MeshBuilder& m = p.mesh;
  if (w > 0.52F) {  // a vanity: a cabinet below
    const float y0 = -d / 2 + 0.055F, top = h - 0.06F;
    m.box(wood, {-w / 2 + 0.03F, y0 + 0.04F, 0}, {w / 2 - 0.03F, d / 2, 0.08F});
    m.box(wood, {-w / 2 + 0.012F, y0, 0.081F}, {w / 2 - 0.012F, d / 2, top - 0.17F});
    m.box(wood, {-w / 2 + 0.012F, y0, top - 0.169F}, {w / 2 - 0.012F, y0 + 0.02F, top});
    const MaterialId grip = p.fixed(tap_chrome());
    const int doors = w > 0.9F ? 3 : 2;
    const float each = (w - 0.024F) / static_cast<float>(doors);
    for (int i = 0; i < doors; ++i) {
      const float a = -w / 2 + 0.012F + each * static_cast<float>(i) + 0.003F,
                  b = a + each - 0.006F;
      m.box(wood, {a, y0 - 0.02F, 0.09F}, {b, y0 - 0.001F, top - 0.01F},
            {.bevel_m = 0.004F, .grain_axis = 2});
      handle(p, grip, {0.5F * (a + b) - 0.05F, y0 - 0.02F, top - 0.06F},
             {0.5F * (a + b) + 0.05F, y0 - 0.02F, top - 0.06F}, 0.025F);
    }
  } else {  // on a foot
    const std::array<Vector2f, 6> foot = {{{0.9F, 0},
                                           {0.75F, 0.03F},
                                           {0.55F, 0.15F},
                                           {0.5F, 0.4F},
                                           {0.65F, 0.6F},
                                           {0.95F, h - 0.17F}}};
    oval(p, white, {0, 0.14F * d, 0}, {0.10F, 0.10F, 0.9F}, foot, 18);
    const std::array<Vector2f, 4> belly = {
        {{0.35F, h - 0.19F}, {0.7F, h - 0.15F}, {0.93F, h - 0.08F}, {0.97F, h - 0.055F}}};
    oval(p, white, {0, 0, 0}, {w / 2, d / 2, 0.6F}, belly, 30);
  }
  // The slab and its basin, as one closed shape.
  p.part("sink", "sink");
  const float bx = std::min(0.42F * w, 0.25F), by = 0.33F * d, cy = -0.06F * d;
  m.box(white, {-w / 2, -d / 2, h - 0.055F}, {-bx, d / 2, h}, {.bevel_m = 0.012F});
  m.box(white, {bx, -d / 2, h - 0.055F}, {w / 2, d / 2, h}, {.bevel_m = 0.012F});
  m.box(white, {-bx, -d / 2, h - 0.055F}, {bx, cy - by, h}, {.bevel_m = 0.012F});
  m.box(white, {-bx, cy + by, h - 0.055F}, {bx, d / 2, h}, {.bevel_m = 0.012F});
  const std::array<Vector2f, 7> hollow = {{{1.06F, h - 0.001F},
                                           {0.99F, h - 0.006F},
                                           {0.93F, h - 0.04F},
                                           {0.8F, h - 0.09F},
                                           {0.55F, h - 0.13F},
                                           {0.2F, h - 0.145F},
                                           {0.01F, h - 0.145F}}};
  oval(p, white, {0, cy, 0}, {bx, by, 0.55F}, hollow, 32);
  m.cylinder(p.fixed(tap_chrome()), {0, cy, h - 0.144F}, {0, cy, h - 0.14F}, {0.022F, 0.02F}, 14);
  tap(p, {0, cy + by + 0.035F, h - 0.002F}, 0.13F);
  p.body();
}

void washing_machine(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("plastic", {232, 234, 234}, 0.1, 68));
  const MaterialId gray = p.fixed(plain("plastic", {150, 154, 158}, 0.2, 69));
  const MaterialId dark = p.fixed(plain("glass", {38, 44, 52}, 0.3, 70)),
                   metal = p.fixed(tap_chrome());
  MeshBuilder& m = p.mesh;
  const float y = -d / 2 + 0.05F;
  m.box(body, {-w / 2, y, 0.02F}, {w / 2, d / 2, h}, {.bevel_m = 0.012F});
  m.box(gray, {-w / 2 + 0.02F, y + 0.03F, 0}, {w / 2 - 0.02F, d / 2 - 0.02F, 0.0195F},
        {.bevel_m = 0.0F});
  m.box(gray, {-w / 2 + 0.006F, y - 0.006F, h - 0.13F}, {w / 2 - 0.006F, y + 0.001F, h - 0.015F});
  m.box(body, {-w / 2 + 0.02F, y - 0.012F, h - 0.12F}, {-w / 2 + 0.2F, y - 0.005F, h - 0.03F});
  m.cylinder(metal, {0.02F, y - 0.005F, h - 0.07F}, {0.02F, y - 0.035F, h - 0.07F},
             {0.033F, 0.028F}, 18);
  m.box(dark, {0.09F, y - 0.008F, h - 0.10F}, {w / 2 - 0.03F, y - 0.005F, h - 0.045F},
        {.bevel_m = 0.0F});
  m.push(translation(0, y, 0.47F * h) * turn(Vector3f::UnitX(), 1.57079633F));  // z points to -y
  m.lathe(metal, {0, 0, 0},
          std::array<Vector2f, 5>{
              {{0.215F, 0}, {0.21F, 0.025F}, {0.175F, 0.045F}, {0.15F, 0.04F}, {0.145F, 0.02F}}},
          36);
  m.lathe(dark, {0, 0, 0},
          std::array<Vector2f, 4>{
              {{0.15F, 0.022F}, {0.11F, 0.012F}, {0.05F, 0.004F}, {0.001F, 0.003F}}},
          30);
  m.pop();
  m.box(gray, {-w / 2 + 0.04F, y - 0.004F, 0.06F}, {-w / 2 + 0.18F, y + 0.001F, 0.15F});
}

void laundry_basket(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("knit", {188, 164, 126}, 0.6, 71));
  const MaterialId cloth = p.material("fabric", plain("fabric", {150, 160, 186}, 0.5, 72));
  const std::array<Vector2f, 5> side = {
      {{0.01F, 0.0F}, {0.82F, 0.0F}, {0.9F, 0.4F * h}, {0.98F, 0.9F * h}, {1.0F, 0.93F * h}}};
  oval(p, body, {0, 0, 0}, {w / 2, d / 2, 0.6F}, side, 28);
  const std::array<Vector2f, 3> inner = {{{0.97F, 0.93F * h}, {0.93F, 0.8F * h}, {0.9F, 0.6F * h}}};
  oval(p, body, {0, 0, 0}, {w / 2, d / 2, 0.6F}, inner, 28);
  for (int i = 0; i < 4; ++i) {
    const float a = 1.571F * static_cast<float>(i);
    p.mesh.push(translation(0.17F * w * std::cos(a), 0.17F * d * std::sin(a), 0.80F * h) *
                turn(Vector3f::UnitY(), 0.4F * std::cos(2.0F * a)));
    p.mesh.cushion(cloth, {0, 0, 0}, {0.45F * w, 0.42F * d, 0.16F * h}, 0.05F * w, 0.01F, 0.05F);
    p.mesh.pop();
  }
}

void trash_can(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("plastic", {90, 94, 98}, 0.2, 73));
  const MaterialId bag = p.fixed(plain("plastic", {30, 31, 33}, 0.4, 74));
  const float square = p.random.uniform(4) < 0.5 ? 1.0F : 0.35F;
  const std::array<Vector2f, 6> side = {{{0.01F, 0.0F},
                                         {0.76F, 0.0F},
                                         {0.78F, 0.01F},
                                         {0.97F, 0.97F * h},
                                         {1.0F, h - 0.004F},
                                         {0.96F, h}}};
  oval(p, body, {0, 0, 0}, {w / 2, d / 2, square}, side, 28);
  const std::array<Vector2f, 5> inner = {{{0.965F, h - 0.001F},
                                          {0.94F, 0.9F * h},
                                          {0.9F, 0.72F * h},
                                          {0.5F, 0.66F * h},
                                          {0.01F, 0.68F * h}}};
  oval(p, bag, {0, 0, 0}, {w / 2, d / 2, square}, inner, 28);
}

void toilet_paper(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId paper = p.fixed(plain("plaster", {240, 240, 236}, 0.3, 75)),
                   metal = p.fixed(tap_chrome());
  MeshBuilder& m = p.mesh;
  const float r = std::min(0.4F * h, 0.45F * d), y = d / 2 - r - 0.012F, z = 0.55F * h;
  m.cylinder(paper, {-0.42F * w, y, z}, {0.36F * w, y, z}, {r, r}, 22);
  m.box(paper, {-0.42F * w, y - r, 0.02F * h}, {0.36F * w, y - r + 0.002F, z}, {.bevel_m = 0.0F});
  m.cylinder(metal, {-0.48F * w, y, z}, {0.42F * w, y, z}, {0.008F, 0.008F}, 8);
  m.cylinder(metal, {0.42F * w, y, z}, {0.42F * w, d / 2, z}, {0.008F, 0.012F}, 8);
}

void radiator(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId white = p.material("body", plain("plastic", {232, 231, 226}, 0.1, 76));
  MeshBuilder& m = p.mesh;
  const int ribs = std::max(3, static_cast<int>(w / 0.075F));
  const float each = w / static_cast<float>(ribs);
  for (int i = 0; i < ribs; ++i) {
    const float x = -w / 2 + each * static_cast<float>(i);
    m.box(white, {x + 0.008F, -d / 2 + 0.01F, 0.05F * h},
          {x + each - 0.008F, d / 2 - 0.02F, 0.95F * h}, {.bevel_m = 0.012F});
  }
  for (const float z : {0.08F * h, 0.88F * h})
    m.box(white, {-w / 2 + 0.004F, -d / 2 + 0.03F, z},
          {w / 2 - 0.004F, d / 2 - 0.03F, z + 0.05F * h});
}

void blinds(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId slat = p.material("body", plain("plastic", {222, 220, 212}, 0.1, 77));
  MeshBuilder& m = p.mesh;
  m.box(slat, {-w / 2, -d / 2, h - 0.035F}, {w / 2, d / 2, h});
  const int n = std::max(2, static_cast<int>((h - 0.04F) / 0.035F));
  for (int i = 0; i < n; ++i) {
    const float z = h - 0.05F - 0.035F * static_cast<float>(i);
    if (z < 0.02F) break;
    m.push(translation(0, 0, z) * turn(Vector3f::UnitX(), 0.6F));
    m.box(slat, {-w / 2 + 0.005F, -0.42F * d, -0.001F}, {w / 2 - 0.005F, 0.42F * d, 0.001F},
          {.bevel_m = 0.0F});
    m.pop();
  }
  for (const float s : {-0.35F, 0.35F})
    m.cylinder(slat, {s * w, 0, 0.0F}, {s * w, 0, h - 0.03F}, {0.0015F, 0.0015F}, 4, false);
}

}  // namespace mh::build
