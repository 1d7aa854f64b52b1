// SPDX-License-Identifier: Apache-2.0
// Cases with open fronts.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

namespace {

constexpr float kBoard = 0.02F;

/// Sides, top, bottom (at z0) and back of a case, open to the front.
void carcass(Piece& p, MaterialId wood, float z0, float z1) {
  const float x = p.size_m.x() / 2, y = p.size_m.y() / 2;
  MeshBuilder& m = p.mesh;
  m.box(wood, {-x, -y, z0}, {-x + kBoard, y, z1 - kBoard - 0.0005F}, {.grain_axis = 2});
  m.box(wood, {x - kBoard, -y, z0}, {x, y, z1 - kBoard - 0.0005F}, {.grain_axis = 2});
  m.box(wood, {-x, -y, z1 - kBoard}, {x, y, z1}, {.grain_axis = 0});
  m.box(wood, {-x + kBoard + 0.0005F, -y + 0.004F, z0},
        {x - kBoard - 0.0005F, y - 0.013F, z0 + kBoard}, {.grain_axis = 0});
  m.box(wood, {-x + kBoard + 0.0005F, y - 0.012F, z0},
        {x - kBoard - 0.0005F, y, z1 - kBoard - 0.0005F}, {.bevel_m = 0.0F, .grain_axis = 2});
}

void board(Piece& p, MaterialId wood, float z) {
  const float x = p.size_m.x() / 2, y = p.size_m.y() / 2;
  p.mesh.box(wood, {-x + kBoard + 0.0005F, -y + 0.006F, z},
             {x - kBoard - 0.0005F, y - 0.0125F, z + kBoard}, {.bevel_m = 0.003F, .grain_axis = 0});
}

}  // namespace

void bookshelf(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak());
  carcass(p, wood, 0.06F, h);
  p.mesh.box(wood, {-w / 2 + 0.021F, -d / 2 + 0.02F, 0}, {w / 2 - 0.021F, d / 2 - 0.02F, 0.0595F});
  const int rows = std::max(2, static_cast<int>((h - 0.08F) / 0.34F));
  const float pitch = (h - 0.08F - kBoard) / static_cast<float>(rows);
  for (int i = 1; i < rows; ++i) board(p, wood, 0.06F + pitch * static_cast<float>(i));
  for (int i = 0; i < rows; ++i) {
    const float z = 0.06F + kBoard + pitch * static_cast<float>(i) + 0.0005F;
    const float fill =
        static_cast<float>(p.random.uniform(static_cast<std::uint64_t>(40 + i), 0.55, 1.0));
    p.part(fmt::format("books_{}", i + 1), "books");
    books(p,
          {-w / 2 + 0.026F, -w / 2 + 0.026F + fill * (w - 0.055F), -d / 2 + 0.03F, z,
           pitch - kBoard - 0.02F, d - 0.06F},
          static_cast<std::uint64_t>(i));
    if (fill < 0.85F) {  // an ornament in the remaining space
      const float space = (1.0F - fill) * w, r = std::min(0.07F, 0.38F * space);
      const float tall = std::min(0.22F, pitch - 0.08F);
      p.part(fmt::format("vase_{}", i + 1), "vase");
      const MaterialId clay =
          p.fixed(plain("ceramic", i % 2 ? Rgb8{190, 120, 84} : Rgb8{86, 120, 140}, 0.3, 4));
      const std::array<Eigen::Vector2f, 8> profile = {{{0.001F, 0},
                                                       {0.6F * r, 0},
                                                       {r, 0.35F * tall},
                                                       {0.9F * r, 0.55F * tall},
                                                       {0.4F * r, 0.8F * tall},
                                                       {0.35F * r, 0.9F * tall},
                                                       {0.5F * r, tall},
                                                       {0.001F, 0.9F * tall}}};
      p.mesh.lathe(clay, {w / 2 - kBoard - 0.5F * space, 0, z}, profile, 14);
    }
    p.body();
  }
}

void open_shelf(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak());
  MeshBuilder& m = p.mesh;
  for (const float sx : {-1.0F, 1.0F})
    for (const float sy : {-1.0F, 1.0F}) {
      const float x = sx * (w / 2 - 0.0155F), y = sy * (d / 2 - 0.0155F);
      m.box(wood, {x - 0.015F, y - 0.015F, 0}, {x + 0.015F, y + 0.015F, h - 0.001F},
            {.grain_axis = 2});
    }
  const int boards = std::max(3, static_cast<int>(h / 0.38F) + 1);
  const std::array<Rgb8, 4> tones = {
      {{196, 180, 150}, {92, 128, 120}, {176, 84, 60}, {70, 88, 124}}};
  for (int i = 0; i < boards; ++i) {
    const float z = i == boards - 1 ? h - 0.02F
                                    : 0.10F + (h - 0.12F) * static_cast<float>(i) /
                                                  static_cast<float>(boards - 1);
    const bool top = i == boards - 1;
    const float e = top ? 0.0F : 0.004F;
    m.box(wood, {-w / 2 + e, -d / 2 + e, z}, {w / 2 - e, d / 2 - e, z + 0.02F}, {.grain_axis = 0});
    if (top) break;
    // Things on the boards: baskets, jars, stacks of bowls, in random order.
    float x = -w / 2 + 0.05F;
    for (int k = 0; x < w / 2 - 0.12F; ++k) {
      const RandomStream r = p.random.fork(static_cast<std::uint64_t>(100 * i + k));
      const Rgb8 tone = tones[r.below(0, tones.size())];
      const float room = w / 2 - 0.05F - x, zz = z + 0.0205F;
      const auto what = r.below(1, 3);
      const std::string number = fmt::format("{}_{}", i + 1, k + 1);
      if (what == 0 && room > 0.26F) {
        p.part("box_" + number, "box");
        const MaterialId basket = p.fixed(plain("knit", {176, 146, 104}, 0.7, 11));
        m.box(basket, {x, -d / 2 + 0.04F, zz}, {x + 0.24F, d / 2 - 0.04F, zz + 0.17F},
              {.bevel_m = 0.012F});
        x += 0.28F;
      } else if (what == 1 || room < 0.18F) {
        p.part("bottle_" + number, "bottle");
        const MaterialId jar = p.fixed(plain("ceramic", tone, 0.3, 12));
        const float rr = 0.045F, tall = static_cast<float>(r.uniform(2, 0.14, 0.22));
        const std::array<Eigen::Vector2f, 7> profile = {{{0.001F, 0},
                                                         {rr, 0.0F},
                                                         {rr, 0.75F * tall},
                                                         {0.7F * rr, 0.85F * tall},
                                                         {0.75F * rr, 0.86F * tall},
                                                         {0.75F * rr, tall},
                                                         {0.001F, tall}}};
        m.lathe(jar, {x + rr, static_cast<float>(r.uniform(3, -0.03, 0.03)), zz}, profile, 14);
        x += 0.12F;
      } else {
        p.part("bowl_" + number, "bowl");
        const MaterialId china = p.fixed(plain("ceramic", {224, 222, 214}, 0.2, 13));
        for (int q = 0; q < 3; ++q) {
          const float zq = zz + 0.035F * static_cast<float>(q);
          const std::array<Eigen::Vector2f, 6> profile = {{{0.001F, 0},
                                                           {0.04F, 0},
                                                           {0.08F, 0.055F},
                                                           {0.083F, 0.058F},
                                                           {0.076F, 0.055F},
                                                           {0.001F, 0.012F}}};
          m.lathe(china, {x + 0.085F, 0.0F, zq}, profile, 16);
        }
        x += 0.20F;
      }
      p.body();
    }
  }
}

void wall_shelf(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak());
  MeshBuilder& m = p.mesh;
  m.box(wood, {-w / 2, -d / 2, 0.05F}, {w / 2, d / 2, 0.075F}, {.grain_axis = 0});
  for (const float sx : {-1.0F, 1.0F})
    m.box(wood, {sx * (w / 2 - 0.12F) - 0.012F, -d / 2 + 0.05F, 0.0F},
          {sx * (w / 2 - 0.12F) + 0.012F, d / 2, 0.0495F});
  p.part("books", "books");
  books(p, {-w / 2 + 0.02F, w / 2 - 0.26F, -d / 2 + 0.02F, 0.0755F, h - 0.085F, d - 0.05F}, 0);
  p.part("vase", "vase");
  const std::array<Eigen::Vector2f, 6> profile = {
      {{0.001F, 0}, {0.05F, 0}, {0.06F, 0.08F}, {0.03F, 0.15F}, {0.035F, 0.17F}, {0.001F, 0.14F}}};
  m.lathe(p.fixed(plain("ceramic", {200, 150, 60}, 0.3, 14)), {w / 2 - 0.13F, 0, 0.0755F}, profile,
          16);
  p.body();
}

void shoe_shelf(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak());
  carcass(p, wood, 0.05F, h);
  p.mesh.box(wood, {-w / 2 + 0.021F, -d / 2 + 0.02F, 0}, {w / 2 - 0.021F, d / 2 - 0.02F, 0.0495F});
  const int rows = 4;
  const float pitch = (h - 0.07F) / static_cast<float>(rows);
  const std::array<Rgb8, 5> tones = {
      {{40, 36, 36}, {112, 70, 44}, {196, 194, 190}, {58, 72, 110}, {150, 50, 50}}};
  for (int i = 0; i < rows; ++i) {
    const float z = 0.05F + pitch * static_cast<float>(i);
    if (i > 0) board(p, wood, z);
    const int pairs = static_cast<int>((w - 0.08F) / 0.24F);
    for (int k = 0; k < pairs; ++k) {
      const RandomStream r = p.random.fork(static_cast<std::uint64_t>(10 * i + k));
      if (r.uniform(0) < 0.25) continue;
      p.part(fmt::format("shoes_{}_{}", i + 1, k + 1), "clothes");
      const MaterialId stuff = p.fixed(plain("leather", tones[r.below(1, tones.size())], 0.4, 21));
      const MaterialId sole = p.fixed(plain("plastic", {226, 220, 206}, 0.1, 22));
      for (const float side : {-1.0F, 1.0F}) {
        const float x = -w / 2 + 0.04F + 0.24F * (static_cast<float>(k) + 0.5F) + side * 0.052F;
        const float y = -d / 2 + 0.03F, zz = z + kBoard + 0.001F;
        p.mesh.cushion(sole, {x, y + 0.13F, zz + 0.011F}, {0.088F, 0.26F, 0.022F}, 0.011F, 0.0F,
                       0.09F);
        p.mesh.cushion(stuff, {x, y + 0.09F, zz + 0.045F}, {0.082F, 0.17F, 0.06F}, 0.028F, 0.004F,
                       0.07F);
        p.mesh.cushion(stuff, {x, y + 0.19F, zz + 0.066F}, {0.078F, 0.12F, 0.10F}, 0.03F, 0.0F,
                       0.07F);
      }
      p.body();
    }
  }
}

void tv_board(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak()), grip = grip_metal(p);
  carcass(p, wood, 0.08F, h);
  MeshBuilder& m = p.mesh;
  m.box(wood, {-w / 2 + 0.03F, -d / 2 + 0.05F, 0}, {w / 2 - 0.03F, d / 2 - 0.03F, 0.0795F});
  const float third = w / 6;  // the open middle
  for (const float sx : {-1.0F, 1.0F}) {
    m.box(wood, {sx * third - 0.01F, -d / 2 + 0.004F, 0.1005F},
          {sx * third + 0.01F, d / 2 - 0.0125F, h - 0.0205F});
    const float a = sx < 0 ? -w / 2 + 0.022F : third + 0.012F,
                b = sx < 0 ? -third - 0.012F : w / 2 - 0.022F;
    m.box(wood, {a, -d / 2 + 0.035F, 0.1005F}, {b, -d / 2 + 0.053F, h - 0.0215F},
          {.bevel_m = 0.004F, .grain_axis = 0});
    handle(p, grip, {0.5F * (a + b) - 0.07F, -d / 2 + 0.035F, 0.30F},
           {0.5F * (a + b) + 0.07F, -d / 2 + 0.035F, 0.30F}, 0.024F);
  }
  m.box(wood, {-third + 0.0105F, -d / 2 + 0.02F, 0.26F},
        {third - 0.0105F, d / 2 - 0.0125F, 0.275F});
  p.part("player", "otherprop");
  const MaterialId black = p.fixed(plain("plastic", {28, 28, 30}, 0.2, 2));
  m.box(black, {-0.19F, -d / 2 + 0.05F, 0.2755F}, {0.19F, d / 2 - 0.06F, 0.33F},
        {.bevel_m = 0.006F});
  m.box(p.fixed(plain("plastic", {60, 160, 190}, 0.1), {0.05F, 0.3F, 0.4F}),
        {0.05F, -d / 2 + 0.049F, 0.295F}, {0.13F, -d / 2 + 0.0502F, 0.312F}, {.bevel_m = 0.0F});
  p.part("books", "books");
  books(p, {-third + 0.02F, third - 0.10F, -d / 2 + 0.04F, 0.1005F, 0.155F, d - 0.12F}, 3);
  p.body();
}

void book_stack(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const std::array<Rgb8, 6> tones = {{{168, 60, 48},
                                      {46, 82, 120},
                                      {206, 170, 92},
                                      {58, 104, 82},
                                      {212, 206, 194},
                                      {96, 70, 110}}};
  const MaterialId pages = p.fixed(plain("plaster", {228, 220, 200}, 0.3, 9));
  const int n = std::max(1, static_cast<int>(h / 0.028F));
  const float thick = h / static_cast<float>(n);
  for (int i = 0; i < n; ++i) {
    const RandomStream r = p.random.fork(static_cast<std::uint64_t>(i));
    const float k =
        1.0F - static_cast<float>(r.uniform(0, 0.0, 0.06)) - 0.04F * static_cast<float>(i);
    const float x = 0.5F * k * w * 0.93F, y = 0.5F * k * d * 0.93F,
                z = thick * static_cast<float>(i);
    const Rgb8 tone = tones[(r.below(1, tones.size()))];
    MaterialSpec cover_spec = plain("book_covers", tone, 0.7, 300 + r.below(2, 1000));
    cover_spec.size_m = {2 * y, 2 * x};
    const MaterialId cover = p.fixed(plain("plastic", tone, 0.2, 3));
    p.mesh.push(turn_z(static_cast<float>(r.uniform(3, -0.07, 0.07))));
    p.mesh.box(cover, {-x, -y, z}, {x, y, z + 0.003F}, {.bevel_m = 0.0F});
    p.mesh.box(pages, {-x + 0.004F, -y + 0.004F, z + 0.003F},
               {x - 0.004F, y - 0.001F, z + thick - 0.004F}, {.bevel_m = 0.0F});
    p.mesh.box(cover, {-x, -y, z + thick - 0.004F}, {x, y, z + thick - 0.001F}, {.bevel_m = 0.0F});
    p.mesh.box(cover, {-x, y - 0.003F, z + 0.003F}, {x, y, z + thick - 0.004F}, {.bevel_m = 0.0F});
    if (i == n - 1)  // the cover's image, its top toward +x
      p.mesh.image(p.fixed(cover_spec), {x, y, z + thick - 0.0005F}, {0, -2 * y, 0},
                   {-2 * x, 0, 0});
    p.mesh.pop();
  }
}

}  // namespace mh::build
