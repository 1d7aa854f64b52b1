// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

MaterialSpec black_plastic() {
  return plain("plastic", {26, 26, 28}, 0.2, 2);
}

/// A frame of four bars without miters, and the image in it, `image_inset` behind the frame's
/// front.
void framed(Piece& p, MaterialId frame, MaterialId image, float bar, float image_inset) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  MeshBuilder& m = p.mesh;
  const BoxStyle up{.bevel_m = 0.003F, .grain_axis = 2}, along{.bevel_m = 0.003F, .grain_axis = 0};
  m.box(frame, {-w / 2, -d / 2, 0}, {-w / 2 + bar, d / 2, h}, up);
  m.box(frame, {w / 2 - bar, -d / 2, 0}, {w / 2, d / 2, h}, up);
  m.box(frame, {-w / 2 + bar, -d / 2, 0}, {w / 2 - bar, d / 2, bar}, along);
  m.box(frame, {-w / 2 + bar, -d / 2, h - bar}, {w / 2 - bar, d / 2, h}, along);
  const float y = -d / 2 + image_inset, e = bar - 0.001F;
  m.image(image, {-w / 2 + e, y, h - e}, {w - 2 * e, 0, 0}, {0, 0, -(h - 2 * e)});
}

}  // namespace

void television(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId black = p.fixed(black_plastic());
  const MaterialId body = p.fixed(plain("plastic", {44, 44, 46}, 0.2, 3));
  MaterialSpec usual = plain("screen", {70, 110, 150}, 0.7, 121);
  const float z0 = 0.07F, bar = 0.014F;
  usual.size_m = {w - 2 * bar, h - z0 - 2 * bar};
  const MaterialId screen = p.material("screen", usual, {0.06F, 0.08F, 0.10F});
  MeshBuilder& m = p.mesh;
  m.box(black, {-w / 2, -0.015F, z0}, {w / 2, 0.02F, h}, {.bevel_m = 0.004F});
  m.box(body, {-0.36F * w, 0.0205F, z0 + 0.08F}, {0.36F * w, 0.05F, h - 0.14F}, {.bevel_m = 0.01F});
  m.image(screen, {-w / 2 + bar, -0.0165F, h - bar}, {w - 2 * bar, 0, 0},
          {0, 0, -(h - z0 - 2 * bar)});
  for (const float s : {-1.0F, 1.0F}) {  // two splayed feet
    m.beam(body, {s * 0.32F * w, 0, z0 + 0.01F}, {s * 0.34F * w, -d / 2 + 0.012F, 0.008F}, 0.02F,
           0.014F);
    m.beam(body, {s * 0.32F * w, 0.004F, z0 + 0.01F}, {s * 0.34F * w, d / 2 - 0.012F, 0.008F},
           0.02F, 0.014F);
  }
}

void laptop(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId shell = p.material("body", plain("brushed_metal", {168, 170, 174}, 0.25, 122));
  const MaterialId black = p.fixed(black_plastic());
  const float deep = 0.76F * d, y0 = -d / 2, hinge = y0 + deep;
  MeshBuilder& m = p.mesh;
  m.box(shell, {-w / 2, y0, 0.002F}, {w / 2, hinge, 0.016F}, {.bevel_m = 0.003F});
  for (int row = 0; row < 5; ++row)
    for (int k = 0; k < 13; ++k) {
      const float kw = 0.066F * w,
                  x = -0.44F * w + kw * static_cast<float>(k) + (row % 2 ? 0.008F : 0.0F);
      const float y = hinge - 0.05F - 0.021F * static_cast<float>(row);
      m.box(black, {x, y, 0.0155F}, {x + 0.85F * kw, y + 0.017F, 0.018F}, {.bevel_m = 0.0F});
    }
  m.box(p.fixed(plain("plastic", {140, 142, 146}, 0.1, 4)), {-0.15F * w, y0 + 0.015F, 0.0155F},
        {0.15F * w, y0 + 0.075F, 0.0168F}, {.bevel_m = 0.0F});
  // The lid, leaning back.
  const float tall = h - 0.012F;
  m.push(translation(0, hinge - 0.004F, 0.014F) *
         turn(Vector3f::UnitX(), -std::atan2(0.24F * d - 0.01F, tall)));
  m.box(shell, {-w / 2, 0, 0}, {w / 2, 0.007F, 0.97F * tall}, {.bevel_m = 0.002F});
  MaterialSpec usual = plain("screen", {90, 120, 160}, 0.8, 123);
  usual.size_m = {w - 0.02F, 0.97F * tall - 0.025F};
  m.image(p.material("screen", usual, {0.10F, 0.12F, 0.14F}),
          {-w / 2 + 0.01F, -0.001F, 0.97F * tall - 0.01F}, {w - 0.02F, 0, 0},
          {0, 0, -(0.97F * tall - 0.025F)});
  m.pop();
}

void picture(Piece& p) {
  const float w = p.size_m.x(), h = p.size_m.z(), bar = std::min(0.03F, 0.05F * w + 0.005F),
              e = bar - 0.001F;
  MaterialSpec usual = plain("painting", {120, 130, 140}, 0.8, 51);
  usual.size_m = {w - 2 * e, h - 2 * e};
  const MaterialId image = p.material("image", usual);
  framed(p, p.material("frame", oak()), image, bar, 0.006F);
}

void photo_frame(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z(), bar = 0.018F;
  MaterialSpec usual = plain("painting", {170, 150, 120}, 0.7, 55);
  usual.size_m = {w - 2 * bar, h - 2 * bar};
  const MaterialId image = p.material("image", usual), frame = p.material("frame", oak());
  MeshBuilder& m = p.mesh;
  m.push(translation(0, -d / 2 + 0.012F, 0.002F) * turn(Vector3f::UnitX(), -0.22F));
  const float top = h - 0.012F;
  m.box(frame, {-w / 2, -0.006F, 0}, {-w / 2 + bar, 0.006F, top}, {.grain_axis = 2});
  m.box(frame, {w / 2 - bar, -0.006F, 0}, {w / 2, 0.006F, top}, {.grain_axis = 2});
  m.box(frame, {-w / 2 + bar, -0.006F, 0}, {w / 2 - bar, 0.006F, bar});
  m.box(frame, {-w / 2 + bar, -0.006F, top - bar}, {w / 2 - bar, 0.006F, top});
  m.box(frame, {-w / 2 + bar, 0.0F, bar}, {w / 2 - bar, 0.005F, top - bar}, {.bevel_m = 0.0F});
  m.image(image, {-w / 2 + bar, -0.001F, top - bar}, {w - 2 * bar, 0, 0}, {0, 0, -(top - 2 * bar)});
  m.pop();
  m.beam(frame, {0, d / 2 - 0.012F, 0.002F}, {0, -d / 2 + 0.055F, 0.6F * h}, 0.03F, 0.005F);
}

void mirror(Piece& p) {
  const float w = p.size_m.x(), h = p.size_m.z(), bar = 0.035F;
  // The renderer has no reflections, so a mirror is a plain silvery pane.
  const MaterialId pane = p.material("glass", plain("glass", {178, 190, 196}, 0.15, 124));
  p.mesh.max_edge_m = 0.08F;
  framed(p, p.material("frame", oak()), pane, bar, 0.008F);
  p.mesh.max_edge_m = 0.12F;
  (void)w;
  (void)h;
}

void light_switch(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("plastic", {234, 234, 230}, 0.1, 126));
  p.mesh.box(body, {-w / 2, -d / 2 + 0.005F, 0}, {w / 2, d / 2, h}, {.bevel_m = 0.002F});
  // The rocker protrudes at its top.
  p.mesh.box(body, {-0.36F * w, -d / 2 + 0.002F, 0.14F * h},
             {0.36F * w, -d / 2 + 0.0049F, 0.5F * h}, {.bevel_m = 0.0F});
  p.mesh.box(body, {-0.36F * w, -d / 2, 0.51F * h}, {0.36F * w, -d / 2 + 0.0049F, 0.86F * h},
             {.bevel_m = 0.0F});
  for (const float z : {0.07F, 0.93F})  // its screws
    p.mesh.cylinder(body, {0, -d / 2 + 0.005F, z * h}, {0, -d / 2 + 0.0035F, z * h},
                    {0.003F, 0.003F}, 8);
}

/// Papers that people tape to walls and cupboard doors: lists, calendars, photographs, drawings.
void wall_papers(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const int columns = std::max(1, static_cast<int>(std::lround(w / 0.27F))),
            rows = std::max(1, static_cast<int>(std::lround(h / 0.32F)));
  const float cw = w / static_cast<float>(columns), ch = h / static_cast<float>(rows);
  const MaterialId tape = p.fixed(plain("plastic", {206, 200, 176}, 0.1, 127));
  MeshBuilder& m = p.mesh;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const RandomStream r = p.random.fork(static_cast<std::uint64_t>(300 + 20 * j + i));
      if (rows * columns > 2 && r.uniform(0) < 0.15) continue;
      const auto part = static_cast<float>(r.uniform(1, 0.72, 0.97));
      const float tall = r.uniform(2) < 0.7 ? 1.41F : 0.71F;  // portrait or landscape sheets
      const float sw = part * std::min(cw, ch / tall), sh = tall * sw;
      const auto x = -w / 2 + cw * static_cast<float>(i) +
                     static_cast<float>(r.uniform(3, 0.0, 1.0)) * (cw - sw);
      const auto z =
          ch * static_cast<float>(j) + static_cast<float>(r.uniform(4, 0.0, 1.0)) * (ch - sh);
      const double what = r.uniform(5);
      constexpr std::array<Rgb8, 4> kTones = {
          {{236, 234, 228}, {240, 226, 150}, {196, 220, 236}, {96, 120, 140}}};
      MaterialSpec print = plain(what < 0.5   ? "paper"
                                 : what < 0.8 ? "poster"
                                              : "painting",
                                 kTones[r.below(6, 4)], 0.7, 5000 + r.below(7, 4000));
      print.size_m = {sw, sh};
      m.box(p.fixed(plain("plaster", {236, 234, 228}, 0.1, 128)), {x, d / 2 - 0.001F, z},
            {x + sw, d / 2, z + sh}, {.bevel_m = 0.0F});
      m.image(p.fixed(print), {x, d / 2 - 0.0016F, z + sh}, {sw, 0, 0}, {0, 0, -sh});
      m.box(tape, {x + 0.4F * sw, d / 2 - 0.0022F, z + sh - 0.014F},
            {x + 0.4F * sw + std::min(0.05F, 0.2F * sw), d / 2 - 0.0017F, z + sh + 0.006F},
            {.bevel_m = 0.0F});
    }
}

void clock(Piece& p) {
  const float r = 0.5F * p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId frame = p.material("frame", plain("wood_grain", {110, 76, 48}, 0.4, 16));
  const MaterialId face = p.fixed(plain("ceramic", {238, 234, 224}, 0.1, 125));
  const MaterialId black = p.fixed(black_plastic());
  const MaterialId red = p.fixed(plain("plastic", {180, 40, 36}, 0.1, 6));
  MeshBuilder& m = p.mesh;
  const float y = -d / 2;
  m.push(translation(0, d / 2, h / 2) *
         turn(Vector3f::UnitX(), 1.57079633F));  // z now points to -y
  m.lathe(frame, {0, 0, 0},
          std::array<Vector2f, 5>{
              {{r, 0}, {r, 0.8F * d}, {0.95F * r, d}, {0.88F * r, d}, {0.87F * r, 0.5F * d}}},
          32);
  m.lathe(face, {0, 0, 0},
          std::array<Vector2f, 4>{{{0.88F * r, 0.52F * d},
                                   {0.6F * r, 0.52F * d},
                                   {0.3F * r, 0.52F * d},
                                   {0.001F, 0.52F * d}}},
          32);
  const float z = 0.53F * d;
  for (int i = 0; i < 12; ++i) {
    const float a = 0.52359878F * static_cast<float>(i);
    m.push(turn_z(a));
    const float half = i % 3 == 0 ? 0.010F : 0.005F;
    m.box(black, {-half, 0.68F * r, z}, {half, 0.82F * r, z + 0.002F}, {.bevel_m = 0.0F});
    m.pop();
  }
  const auto hand = [&](MaterialId material, float angle, float length, float half, float lift) {
    m.push(turn_z(angle));
    m.box(material, {-half, -0.12F * r, z + lift}, {half, length, z + lift + 0.0015F},
          {.bevel_m = 0.0F});
    m.pop();
  };
  hand(black, 1.05F, 0.48F * r, 0.006F, 0.003F);  // ten past ten, as on any clock in a shop window
  hand(black, -1.05F, 0.70F * r, 0.004F, 0.005F);
  hand(red, 2.6F, 0.74F * r, 0.0015F, 0.007F);
  m.cylinder(black, {0, 0, z}, {0, 0, z + 0.009F}, {0.010F, 0.009F}, 12);
  m.pop();
  (void)y;
}

void bottle(Piece& p) {
  const float r = 0.5F * p.size_m.x(), h = p.size_m.z();
  const MaterialId glass = p.material("glass", plain("glass", {52, 84, 58}, 0.3, 126));
  const MaterialId cap = p.fixed(plain("plastic", {190, 160, 60}, 0.2, 7));
  const MaterialId label = p.fixed(plain("plaster", {232, 222, 196}, 0.5, 8));
  const std::array<Vector2f, 9> profile = {{{0.001F, 0},
                                            {0.95F * r, 0},
                                            {r, 0.02F * h},
                                            {r, 0.55F * h},
                                            {0.85F * r, 0.64F * h},
                                            {0.40F * r, 0.75F * h},
                                            {0.36F * r, 0.92F * h},
                                            {0.42F * r, 0.93F * h},
                                            {0.40F * r, 0.955F * h}}};
  p.mesh.lathe(glass, {0, 0, 0}, profile, 16);
  p.mesh.cylinder(cap, {0, 0, 0.93F * h}, {0, 0, h}, {0.44F * r, 0.44F * r}, 12);
  const std::array<Vector2f, 2> band = {{{1.015F * r, 0.16F * h}, {1.015F * r, 0.44F * h}}};
  p.mesh.lathe(label, {0, 0, 0}, band, 16);
}

void cup(Piece& p) {
  const float d = p.size_m.y(), w = p.size_m.x(), h = p.size_m.z(), r = d / 2, cx = -w / 2 + r;
  const MaterialId body = p.material("body", plain("ceramic", {62, 92, 138}, 0.4, 76));
  const MaterialId tea = p.fixed(plain("plastic", {86, 54, 30}, 0.1, 9));
  const std::array<Vector2f, 8> profile = {{{0.001F, 0},
                                            {0.78F * r, 0},
                                            {0.92F * r, 0.12F * h},
                                            {r, 0.6F * h},
                                            {r, h},
                                            {0.92F * r, h},
                                            {0.88F * r, 0.5F * h},
                                            {0.80F * r, 0.2F * h}}};
  p.mesh.lathe(body, {cx, 0, 0}, profile, 20);
  p.mesh.cylinder(tea, {cx, 0, 0.2F * h}, {cx, 0, 0.78F * h}, {0.8F * r, 0.91F * r}, 16);
  std::vector<Vector3f> grip;
  for (int i = 0; i <= 8; ++i) {
    const float a = -1.45F + 2.9F * static_cast<float>(i) / 8.0F;
    grip.emplace_back(cx + 0.90F * r + (w / 2 - cx - 0.90F * r - 0.005F) * std::cos(a), 0,
                      0.52F * h + 0.30F * h * std::sin(a));
  }
  p.mesh.tube(body, grip, 0.0045F, 8);
}

void bowl(Piece& p) {
  const float r = 0.5F * p.size_m.x(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("ceramic", {84, 128, 116}, 0.4, 74));
  const std::array<Vector2f, 11> profile = {{{0.001F, 0.02F * h},
                                             {0.42F * r, 0},
                                             {0.45F * r, 0.10F * h},
                                             {0.62F * r, 0.22F * h},
                                             {0.85F * r, 0.55F * h},
                                             {r, 0.97F * h},
                                             {0.985F * r, h},
                                             {0.96F * r, 0.97F * h},
                                             {0.80F * r, 0.55F * h},
                                             {0.5F * r, 0.26F * h},
                                             {0.001F, 0.2F * h}}};
  p.mesh.lathe(body, {0, 0, 0}, profile, 26);
  if (r < 0.11F) return;
  // Fruit, the upper ones showing over the rim.
  const std::array<Rgb8, 3> tones = {{{206, 120, 40}, {176, 52, 44}, {150, 170, 66}}};
  for (int i = 0; i < 5; ++i) {
    const float a = 1.2566F * static_cast<float>(i), reach = i == 4 ? 0.0F : 0.45F * r;
    const MaterialId fruit =
        p.fixed(plain("ceramic", tones[static_cast<std::size_t>(i) % 3], 0.5, 130));
    const float s = 0.55F * r;
    p.mesh.cushion(fruit,
                   {reach * std::cos(a), reach * std::sin(a),
                    0.34F * h + 0.46F * s + (i == 4 ? 0.16F * s : 0.0F)},
                   {s, s, 0.9F * s}, 0.45F * s, 0.0F, 0.05F);
  }
}

void vase(Piece& p) {
  const float r = 0.5F * p.size_m.x(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("ceramic", {84, 128, 116}, 0.4, 74));
  const auto form = p.random.below(0, 3);
  std::vector<Vector2f> profile;
  if (form == 0)
    profile = {{0.001F, 0},
               {0.5F * r, 0},
               {0.85F * r, 0.18F * h},
               {r, 0.38F * h},
               {0.88F * r, 0.56F * h},
               {0.45F * r, 0.76F * h},
               {0.32F * r, 0.88F * h},
               {0.48F * r, h},
               {0.44F * r, h},
               {0.28F * r, 0.87F * h},
               {0.3F * r, 0.6F * h}};
  else if (form == 1)
    profile = {
        {0.001F, 0},          {0.72F * r, 0},         {0.78F * r, 0.05F * h}, {0.70F * r, 0.3F * h},
        {0.8F * r, 0.6F * h}, {r, 0.85F * h},         {0.94F * r, 0.97F * h}, {0.98F * r, h},
        {0.92F * r, h},       {0.85F * r, 0.85F * h}, {0.6F * r, 0.5F * h}};
  else
    profile = {{0.001F, 0},
               {0.55F * r, 0},
               {r, 0.30F * h},
               {0.96F * r, 0.46F * h},
               {0.58F * r, 0.62F * h},
               {0.26F * r, 0.70F * h},
               {0.22F * r, 0.94F * h},
               {0.34F * r, h},
               {0.30F * r, h},
               {0.17F * r, 0.93F * h},
               {0.17F * r, 0.6F * h}};
  p.mesh.lathe(body, {0, 0, 0}, profile, 24);
}

}  // namespace mh::build
