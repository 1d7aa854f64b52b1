// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector3f;

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

/// A framed door (stile, rail and panel) in the plane y, facing -y, with a handle on one side.
void panel_door(Piece& p, MaterialId wood, MaterialId metal, float x0, float x1, float y, float z0,
                float z1, bool handle_right, float stile = 0.055F) {
  MeshBuilder& m = p.mesh;
  const float t = 0.018F, s = stile;
  const BoxStyle up{.bevel_m = 0.004F, .grain_axis = 2}, along{.bevel_m = 0.004F, .grain_axis = 0};
  m.box(wood, {x0, y - t, z0}, {x0 + s, y, z1}, up);
  m.box(wood, {x1 - s, y - t, z0}, {x1, y, z1}, up);
  m.box(wood, {x0 + s, y - t, z0}, {x1 - s, y, z0 + s}, along);
  m.box(wood, {x0 + s, y - t, z1 - s}, {x1 - s, y, z1}, along);
  m.box(wood, {x0 + s, y - 0.010F, z0 + s}, {x1 - s, y - 0.002F, z1 - s},
        {.bevel_m = 0.0F, .grain_axis = 2});
  const float hx = handle_right ? x1 - s / 2 : x0 + s / 2, middle = 0.5F * (z0 + z1);
  const float reach = std::min(0.08F, 0.3F * (z1 - z0));
  handle(p, metal, {hx, y - t, middle - reach}, {hx, y - t, middle + reach});
}

void drawer_front(Piece& p, MaterialId wood, MaterialId metal, float x0, float x1, float y,
                  float z0, float z1) {
  p.mesh.box(wood, {x0, y - 0.018F, z0}, {x1, y, z1}, {.bevel_m = 0.005F, .grain_axis = 0});
  const float x = 0.5F * (x0 + x1), reach = std::min(0.07F, 0.2F * (x1 - x0)), z = 0.5F * (z0 + z1);
  handle(p, metal, {x - reach, y - 0.018F, z}, {x + reach, y - 0.018F, z});
}

MaterialId metal(Piece& p) {
  return p.material("metal", plain("brushed_metal", {130, 126, 118}, 0.3, 7));
}

/// Plinth and closed case behind door and drawer fronts; returns the plane of the fronts' backs.
float closed_case(Piece& p, MaterialId wood, float plinth, float top) {
  const float x = p.size_m.x() / 2, y = p.size_m.y() / 2, h = p.size_m.z();
  const float front = -y + 0.055F;  // fronts and handles stay inside the footprint
  MeshBuilder& m = p.mesh;
  if (plinth > 0.0F) m.box(wood, {-x + 0.02F, front + 0.02F, 0}, {x - 0.02F, y, plinth - 0.001F});
  m.box(wood, {-x + 0.002F, front, plinth}, {x - 0.002F, y, h - top - 0.001F}, {.grain_axis = 2});
  if (top > 0.0F) {
    m.max_edge_m = 0.08F;
    m.box(wood, {-x, front - 0.022F, h - top}, {x, y, h}, {.bevel_m = 0.005F, .grain_axis = 0});
    m.max_edge_m = 0.12F;
  }
  return front - 0.001F;
}

}  // namespace

MaterialSpec plain(std::string kind, Rgb8 tone, double variation, std::uint64_t seed) {
  MaterialSpec spec;
  spec.kind = std::move(kind);
  spec.tone = tone;
  spec.variation = variation;
  spec.seed = seed;
  return spec;
}

MaterialSpec oak(std::uint64_t seed) {
  return plain("wood_grain", {171, 126, 82}, 0.5, seed);
}

void handle(Piece& p, MaterialId material, const Vector3f& a, const Vector3f& b, float off) {
  const Vector3f out(0, -off, 0);
  const Vector3f in = 0.12F * (b - a);
  p.mesh.cylinder(material, a + out, b + out, 0.005F, 0.005F, 8);
  p.mesh.cylinder(material, a + in, a + in + out, 0.004F, 0.004F, 6, false);
  p.mesh.cylinder(material, b - in, b - in + out, 0.004F, 0.004F, 6, false);
}

void books(Piece& p, float x0, float x1, float front, float z, float height, float depth,
           std::uint64_t row) {
  constexpr std::array<Rgb8, 10> kCovers = {{{150, 46, 40},
                                             {42, 70, 110},
                                             {48, 92, 66},
                                             {196, 160, 80},
                                             {64, 60, 62},
                                             {214, 204, 184},
                                             {120, 74, 104},
                                             {196, 108, 52},
                                             {70, 120, 132},
                                             {110, 84, 56}}};
  const RandomStream random = p.random.fork(7001 + row);
  MaterialSpec rows = plain("book_spines", {140, 110, 90}, 0.8, 500 + random.below(9999, 4));
  rows.size_m = {0.5F, 0.25F};
  const MaterialId spines = p.fixed(rows);
  const MaterialId pages = p.fixed(plain("plaster", {226, 216, 194}, 0.3, 9));
  MeshBuilder& m = p.mesh;
  float x = x0;
  for (std::uint64_t i = 0; x < x1; ++i) {
    const RandomStream book = random.fork(i);
    const float thick = static_cast<float>(book.uniform(0, 0.014, 0.045));
    if (x + thick > x1) break;
    const float tall = height * static_cast<float>(book.uniform(1, 0.72, 0.96));
    const float deep = std::min(depth, static_cast<float>(book.uniform(2, 0.13, 0.20)));
    const float y = front + static_cast<float>(book.uniform(3, 0.0, 0.012));
    const Rgb8 tone = kCovers[book.below(4, kCovers.size())];
    const MaterialId cover = p.fixed(plain("plastic", tone, 0.2, 3));
    // Two boards and a spine round a block of pages, in one box; pages show on top.
    m.box(cover, {x, y, z}, {x + thick - 0.001F, y + deep, z + tall}, {.bevel_m = 0.0F});
    const float u = static_cast<float>(book.uniform(5, 0.0, 0.5 - thick));
    m.picture(spines, {x + 0.0005F, y - 0.0008F, z + tall - 0.001F}, {thick - 0.002F, 0, 0},
              {0, 0, -tall + 0.002F}, {u, 0.075F}, Eigen::Vector2f{thick, 0.17F});
    m.picture(pages, {x + 0.002F, y + deep - 0.001F, z + tall + 0.0006F}, {thick - 0.005F, 0, 0},
              {0, -deep + 0.006F, 0});
    x += thick;
    if (book.uniform(6) < 0.06) x += static_cast<float>(book.uniform(7, 0.02, 0.10));  // a gap
  }
}

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
    books(p, -w / 2 + 0.026F, -w / 2 + 0.026F + fill * (w - 0.055F), -d / 2 + 0.03F, z,
          pitch - kBoard - 0.02F, d - 0.06F, static_cast<std::uint64_t>(i));
    if (fill < 0.85F) {  // an ornament in the space left
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
    // Things on the boards: baskets, jars, stacks of bowls, in an order of their own.
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
  books(p, -w / 2 + 0.02F, w / 2 - 0.26F, -d / 2 + 0.02F, 0.0755F, h - 0.085F, d - 0.05F, 0);
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

void sideboard(Piece& p) {
  const float w = p.size_m.x(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak()), grip = metal(p);
  const float y = closed_case(p, wood, 0.08F, 0.025F);
  const float drawers = h - 0.03F - 0.17F;
  const int n = std::max(2, static_cast<int>(std::lround(w / 0.45F)));
  const float each = (w - 0.02F) / static_cast<float>(n);
  for (int i = 0; i < n; ++i) {
    const float x0 = -w / 2 + 0.01F + each * static_cast<float>(i) + 0.003F,
                x1 = x0 + each - 0.006F;
    panel_door(p, wood, grip, x0, x1, y, 0.09F, drawers - 0.003F, i % 2 == 0);
    drawer_front(p, wood, grip, x0, x1, y, drawers + 0.003F, h - 0.032F);
  }
}

void tv_board(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak()), grip = metal(p);
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
  books(p, -third + 0.02F, third - 0.10F, -d / 2 + 0.04F, 0.1005F, 0.155F, d - 0.12F, 3);
  p.body();
}

void dresser(Piece& p) {
  const float w = p.size_m.x(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak()), grip = metal(p);
  const float y = closed_case(p, wood, 0.07F, 0.025F);
  const int rows = std::max(3, static_cast<int>(std::lround((h - 0.1F) / 0.19F)));
  const float each = (h - 0.08F - 0.035F) / static_cast<float>(rows);
  for (int i = 0; i < rows; ++i) {
    const float z0 = 0.08F + each * static_cast<float>(i) + 0.003F, z1 = z0 + each - 0.006F;
    if (i == rows - 1) {  // two small ones above
      drawer_front(p, wood, grip, -w / 2 + 0.012F, -0.003F, y, z0, z1);
      drawer_front(p, wood, grip, 0.003F, w / 2 - 0.012F, y, z0, z1);
    } else {
      drawer_front(p, wood, grip, -w / 2 + 0.012F, w / 2 - 0.012F, y, z0, z1);
    }
  }
}

void wardrobe(Piece& p) {
  const float w = p.size_m.x(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak()), grip = metal(p);
  const float y = closed_case(p, wood, 0.08F, 0.03F);
  panel_door(p, wood, grip, -w / 2 + 0.008F, -0.003F, y, 0.30F, h - 0.04F, true, 0.07F);
  panel_door(p, wood, grip, 0.003F, w / 2 - 0.008F, y, 0.30F, h - 0.04F, false, 0.07F);
  drawer_front(p, wood, grip, -w / 2 + 0.008F, w / 2 - 0.008F, y, 0.09F, 0.294F);
}

void cupboard(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak()), grip = metal(p);
  const MaterialId china = p.material("china", plain("ceramic", {222, 222, 216}, 0.2, 75));
  const MaterialId blue = p.fixed(plain("ceramic", {72, 100, 150}, 0.3, 76));
  MeshBuilder& m = p.mesh;
  const float x = w / 2, y = d / 2, split = 0.86F;
  // Below: doors. Above: a shallower open case with china.
  m.box(wood, {-x + 0.02F, -y + 0.075F, 0}, {x - 0.02F, y, 0.079F});
  m.box(wood, {-x + 0.002F, -y + 0.055F, 0.08F}, {x - 0.002F, y, split - 0.026F},
        {.grain_axis = 2});
  m.box(wood, {-x, -y + 0.033F, split - 0.025F}, {x, y, split},
        {.bevel_m = 0.005F, .grain_axis = 0});
  panel_door(p, wood, grip, -x + 0.008F, -0.003F, -y + 0.054F, 0.09F, split - 0.032F, true);
  panel_door(p, wood, grip, 0.003F, x - 0.008F, -y + 0.054F, 0.09F, split - 0.032F, false);
  const float front = -y + 0.10F;
  for (const float s : {-1.0F, 1.0F})
    m.box(wood, {s * (x - 0.012F) - 0.01F, front, split + 0.0005F},
          {s * (x - 0.012F) + 0.01F, y, h - 0.0255F}, {.grain_axis = 2});
  m.box(wood, {-x, front - 0.02F, h - 0.025F}, {x, y, h}, {.bevel_m = 0.006F, .grain_axis = 0});
  m.box(wood, {-x + 0.0225F, y - 0.012F, split + 0.0005F}, {x - 0.0225F, y, h - 0.0255F},
        {.bevel_m = 0.0F, .grain_axis = 2});
  const float pitch = (h - 0.025F - split) / 3.0F;
  for (int i = 0; i < 3; ++i) {
    const float z = split + pitch * static_cast<float>(i);
    if (i > 0)
      m.box(wood, {-x + 0.0225F, front + 0.01F, z - 0.02F}, {x - 0.0225F, y - 0.0125F, z},
            {.grain_axis = 0});
    for (int k = 0; k < 5; ++k) {
      const RandomStream r = p.random.fork(static_cast<std::uint64_t>(60 + 10 * i + k));
      const float cx = -x + 0.12F + static_cast<float>(k) * (w - 0.24F) / 4.0F;
      const MaterialId stuff = r.uniform(0) < 0.3 ? blue : china;
      if (i == 1) {  // plates standing on edge at the back
        p.part(fmt::format("plate_{}", k + 1), "bowl");
        m.push(translation(cx, y - 0.05F, z + 0.101F) * turn(Vector3f::UnitX(), 1.35F));
        const std::array<Eigen::Vector2f, 5> plate = {
            {{0.001F, 0}, {0.06F, 0}, {0.098F, 0.014F}, {0.06F, 0.006F}, {0.001F, 0.006F}}};
        m.lathe(stuff, {0, 0, 0}, plate, 20);
        m.pop();
      } else {
        p.part(fmt::format("cup_{}_{}", i + 1, k + 1), "cup");
        const float rr = static_cast<float>(r.uniform(1, 0.035, 0.05)),
                    tall = static_cast<float>(r.uniform(2, 0.07, 0.13));
        const std::array<Eigen::Vector2f, 6> cup = {{{0.001F, 0},
                                                     {0.7F * rr, 0},
                                                     {rr, 0.4F * tall},
                                                     {rr, tall},
                                                     {0.9F * rr, tall - 0.003F},
                                                     {0.001F, 0.2F * tall}}};
        m.lathe(stuff, {cx, front + 0.13F, z + 0.001F}, cup, 16);
      }
      p.body();
    }
  }
}

void box(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("plaster", {178, 142, 100}, 0.4, 78));
  const MaterialId tape = p.fixed(plain("plastic", {206, 186, 140}, 0.2, 5));
  MeshBuilder& m = p.mesh;
  m.box(body, {-w / 2 + 0.002F, -d / 2 + 0.002F, 0}, {w / 2 - 0.002F, d / 2 - 0.002F, h - 0.006F},
        {.bevel_m = 0.006F});
  m.box(body, {-w / 2, -d / 2, h - 0.05F}, {w / 2, d / 2, h - 0.002F}, {.bevel_m = 0.004F});  // lid
  m.box(tape, {-0.022F, -d / 2 - 0.0005F + 0.001F, h - 0.004F}, {0.022F, d / 2 - 0.001F, h},
        {.bevel_m = 0.0F});
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
    if (i == n - 1)  // the cover's picture, its top towards +x
      p.mesh.picture(p.fixed(cover_spec), {x, y, z + thick - 0.0005F}, {0, -2 * y, 0},
                     {-2 * x, 0, 0});
    p.mesh.pop();
  }
}

}  // namespace mh::build
