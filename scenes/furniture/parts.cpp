// SPDX-License-Identifier: Apache-2.0
// Common materials, and parts shared by several kinds of furniture.
#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector2f;
using Eigen::Vector3f;

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

MaterialSpec bare_steel() {
  return plain("brushed_metal", {160, 163, 166}, 0.3, 191);
}

MaterialSpec black_rubber() {
  return plain("plastic", {32, 33, 35}, 0.3, 192);
}

MaterialId grip_metal(Piece& p) {
  return p.material("metal", plain("brushed_metal", {130, 126, 118}, 0.3, 7));
}

void handle(Piece& p, MaterialId material, const Vector3f& a, const Vector3f& b, float off) {
  const Vector3f out(0, -off, 0);
  const Vector3f in = 0.12F * (b - a);
  p.mesh.cylinder(material, a + out, b + out, {0.005F, 0.005F}, 8);
  p.mesh.cylinder(material, a + in, a + in + out, {0.004F, 0.004F}, 6, false);
  p.mesh.cylinder(material, b - in, b - in + out, {0.004F, 0.004F}, 6, false);
}

void books(Piece& p, const BookSpace& space, std::uint64_t row) {
  const auto& [x0, x1, front, z, height, depth] = space;
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
    // Two boards and a spine around a block of pages, as one box; the pages show on top.
    m.box(cover, {x, y, z}, {x + thick - 0.001F, y + deep, z + tall}, {.bevel_m = 0.0F});
    const float u = static_cast<float>(book.uniform(5, 0.0, 0.5 - thick));
    m.image(spines, {x + 0.0005F, y - 0.0008F, z + tall - 0.001F}, {thick - 0.002F, 0, 0},
            {0, 0, -tall + 0.002F}, {u, 0.075F}, Eigen::Vector2f{thick, 0.17F});
    m.image(pages, {x + 0.002F, y + deep - 0.001F, z + tall + 0.0006F}, {thick - 0.005F, 0, 0},
            {0, -deep + 0.006F, 0});
    x += thick;
    if (book.uniform(6) < 0.06) x += static_cast<float>(book.uniform(7, 0.02, 0.10));  // a gap
  }
}

void oval(Piece& p, MaterialId material, const Vector3f& center, const Oval& section,
          std::span<const Vector2f> profile, int sides) {
  const auto& [radius_x, radius_y, square] = section;
  const auto n = static_cast<float>(profile.size() - 1);
  const auto round = [square](float v) { return std::copysign(std::pow(std::abs(v), square), v); };
  p.mesh.sheet(
      material,
      [&](float s, float t) -> Vector3f {
        const float at = (1.0F - t) * n;
        const auto i = std::min(static_cast<std::size_t>(at), profile.size() - 2);
        const Vector2f q =
            profile[i] + (at - static_cast<float>(i)) * (profile[i + 1] - profile[i]);
        const float a = s >= 1.0F ? 0.0F : 6.2831853F * s;
        return center + Vector3f(radius_x * q.x() * round(std::cos(a)),
                                 radius_y * q.x() * round(std::sin(a)), q.y());
      },
      sides, static_cast<int>(profile.size()) - 1,
      {3.0F * (radius_x + radius_y), std::abs(profile.back().y() - profile.front().y()) + 0.05F});
}

}  // namespace mh::build
