// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector3f;

void curtain(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId cloth = p.material("fabric", plain("curtain_fabric", {206, 192, 166}, 0.5, 39));
  const MaterialId rod = p.material("rod", plain("wood_grain", {122, 84, 54}, 0.4, 16));
  const float folds = std::max(3.0F, std::round(w / 0.095F)),
              phase = static_cast<float>(p.random.uniform(0, 0.0, 6.2));
  const int nu = static_cast<int>(folds) * 8;
  const float top = h - 0.03F;
  p.mesh.sheet(cloth,
               [&](float s, float t) -> Vector3f {
                 const float a = 6.2831853F * folds * s;
                 const float swell = 0.55F + 0.45F * t;  // folds widen toward the bottom
                 const float y = swell * 0.36F * d *
                                 (std::sin(a + phase) + 0.22F * std::sin(2.3F * a + 4.0F * t));
                 const float x =
                     (s - 0.5F) * (w - 0.03F) * (0.94F + 0.06F * t) + 0.004F * std::sin(3.0F * a);
                 return {x, std::clamp(y, -0.49F * d, 0.49F * d), top * (1.0F - t)};
               },
               nu, std::max(6, static_cast<int>(h / 0.12F)), {1.5F * w, h});
  p.mesh.cylinder(rod, {-w / 2, 0, h - 0.018F}, {w / 2, 0, h - 0.018F}, {0.012F, 0.012F}, 10);
}

void rug(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  MaterialSpec usual = plain("rug_pattern", {142, 58, 48}, 0.7, 41);
  usual.size_m = {w, d};
  const MaterialId top = p.material("top", usual);
  const MaterialId edge = p.fixed(plain("fabric", {120, 100, 84}, 0.4, 45));
  p.mesh.max_edge_m = 0.08F;
  p.mesh.image(top, {-w / 2, d / 2, h}, {w, 0, 0}, {0, -d, 0});
  p.mesh.max_edge_m = 0.12F;
  for (const float s : {-1.0F, 1.0F}) {  // a bound edge closes the sides
    p.mesh.box(edge, {-w / 2, s * (d / 2) - (s > 0 ? 0.012F : 0.0F), 0.0F},
               {w / 2, s * (d / 2) + (s > 0 ? 0.0F : 0.012F), h + 0.001F}, {.bevel_m = 0.002F});
    p.mesh.box(edge, {s * (w / 2) - (s > 0 ? 0.012F : 0.0F), -d / 2 + 0.0125F, 0.0F},
               {s * (w / 2) + (s > 0 ? 0.0F : 0.012F), d / 2 - 0.0125F, h + 0.001F},
               {.bevel_m = 0.002F});
  }
}

void towel(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId cloth = p.material("fabric", plain("fabric", {132, 152, 178}, 0.5, 38));
  const MaterialId metal = p.fixed(plain("brushed_metal", {186, 188, 190}, 0.3, 8));
  const float rail = h - 0.02F, y = -0.01F;
  p.mesh.cylinder(metal, {-w / 2, y, rail}, {w / 2, y, rail}, {0.007F, 0.007F}, 10);
  for (const float s : {-1.0F, 1.0F})
    p.mesh.cylinder(metal, {s * (w / 2 - 0.01F), y, rail}, {s * (w / 2 - 0.01F), d / 2, rail},
                    {0.006F, 0.010F}, 8);
  const float inner = 0.5F * w - 0.035F;  // front and back flap over the rail
  p.mesh.sheet(cloth,
               [&](float s, float t) -> Vector3f {
                 const float length = 2.0F * h * 0.82F, along = (t - 0.5F) * length;
                 const float x = (2.0F * s - 1.0F) * inner;
                 const float fall = std::max(0.0F, std::abs(along) - 0.014F);
                 const float side = std::clamp(along / 0.014F, -1.0F, 1.0F);
                 const float ripple = 0.006F * std::sin(7.0F * s + (along > 0 ? 1.0F : 0.0F)) *
                                      std::min(1.0F, fall / 0.1F);
                 const float drop = along > 0 ? fall : 0.8F * fall;
                 return {x, y - side * 0.011F - ripple * (side > 0 ? 1.0F : 0.3F),
                         rail + 0.010F * (1.0F - side * side) - drop};
               },
               12, 36, {w, 1.64F * h});
}

namespace {

struct GarmentCut {
  float length, width, depth;
  bool hood;
};

/// A jacket on a hanger, its shoulders at z = top, seen from the front.
void garment(Piece& p, MaterialId cloth, float x, float top, const GarmentCut& cut) {
  const auto [length, width, depth, hood] = cut;
  MeshBuilder& m = p.mesh;
  const auto body = [&](float front) {
    return [=](float s, float t) -> Vector3f {
      const float across = 2.0F * s - 1.0F;
      const float half = 0.5F * width * (0.80F + 0.20F * t);
      const float shoulder = 0.07F * across * across * (1.0F - t);
      const float y =
          front * depth * (0.30F + 0.16F * t) * std::sqrt(std::max(0.0F, 1.0F - across * across));
      const float fold = 0.008F * std::sin(9.0F * across + 2.0F * x) * t;
      return {x + half * across, y + fold, top - shoulder - t * length};
    };
  };
  m.sheet(cloth, body(-1.0F), 14, 12, {width, length});
  m.sheet(cloth, body(1.0F), 14, 12, {width, length});
  for (const float s : {-1.0F, 1.0F}) {  // sleeves
    const std::array<Vector3f, 5> arm = {{{x + s * 0.38F * width, 0, top - 0.07F},
                                          {x + s * 0.46F * width, -0.005F, top - 0.16F},
                                          {x + s * 0.49F * width, -0.01F, top - 0.30F},
                                          {x + s * 0.49F * width, -0.015F, top - 0.45F},
                                          {x + s * 0.48F * width, -0.02F, top - 0.56F}}};
    m.tube(cloth, arm, std::array<float, 5>{0.050F, 0.052F, 0.046F, 0.040F, 0.036F}, 10);
  }
  if (hood) m.cushion(cloth, {x, 0.01F, top - 0.01F}, {0.5F * width, 0.8F * depth, 0.12F}, 0.05F);
}

}  // namespace

void coat_rack(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak());
  const MaterialId metal = p.fixed(plain("brushed_metal", {70, 66, 60}, 0.3, 7));
  MeshBuilder& m = p.mesh;
  const float z = h - 0.14F, y = d / 2;
  m.box(wood, {-w / 2, y - 0.02F, z}, {w / 2, y, z + 0.13F}, {.bevel_m = 0.006F});
  m.box(wood, {-w / 2, y - 0.16F, h - 0.02F}, {w / 2, y - 0.0205F, h},
        {.bevel_m = 0.005F});  // hat shelf
  const int hooks = std::max(3, static_cast<int>(w / 0.2F));
  for (int i = 0; i < hooks; ++i) {
    const float x = -w / 2 + (static_cast<float>(i) + 0.5F) * w / static_cast<float>(hooks);
    const std::array<Vector3f, 5> hook = {{{x, y - 0.018F, z + 0.09F},
                                           {x, y - 0.05F, z + 0.06F},
                                           {x, y - 0.07F, z + 0.04F},
                                           {x, y - 0.085F, z + 0.05F},
                                           {x, y - 0.09F, z + 0.08F}}};
    m.tube(metal, hook, 0.005F, 8);
  }
  const std::array<MaterialSpec, 3> stuffs = {plain("fabric", {58, 70, 92}, 0.5, 101),
                                              plain("knit", {150, 66, 52}, 0.6, 102),
                                              plain("fabric", {126, 118, 92}, 0.5, 103)};
  for (int i = 0; i < 3; ++i) {
    const float x = 0.5F * (w - 0.40F) * static_cast<float>(i - 1);
    p.part(fmt::format("coat_{}", i + 1), "clothes");
    m.push(translation(0, y - 0.105F, 0));
    garment(p, p.fixed(stuffs[static_cast<std::size_t>(i)]), x, z + 0.055F,
            {std::min(0.78F, z - 0.02F), i == 1 ? 0.26F : 0.28F, 0.17F, i != 1});
    m.pop();
  }
  p.part("hat", "clothes");
  const MaterialId straw = p.fixed(plain("knit", {206, 176, 120}, 0.5, 104));
  m.lathe(straw, {0.12F, y - 0.095F, h + 0.0005F - 0.0F},
          std::array<Eigen::Vector2f, 6>{{{0.001F, 0.0F},
                                          {0.070F, 0.0F},
                                          {0.072F, 0.004F},
                                          {0.05F, 0.006F},
                                          {0.044F, 0.07F},
                                          {0.001F, 0.085F}}},
          20);
  p.body();
}

void hook_rail(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId wood = p.material("wood", oak());
  const MaterialId metal = p.fixed(plain("brushed_metal", {150, 152, 156}, 0.3, 111));
  constexpr std::array<Rgb8, 6> kTones = {{{70, 88, 124},
                                           {150, 66, 52},
                                           {206, 196, 176},
                                           {92, 120, 100},
                                           {60, 60, 66},
                                           {190, 150, 80}}};
  MeshBuilder& m = p.mesh;
  const float y = d / 2, bar = h - 0.07F;
  m.box(wood, {-w / 2, y - 0.018F, bar}, {w / 2, y, h}, {.bevel_m = 0.005F, .grain_axis = 0});
  const int n = std::max(3, static_cast<int>(w / 0.17F));
  const float pitch = w / static_cast<float>(n);
  for (int i = 0; i < n; ++i) {
    const float x = -w / 2 + (static_cast<float>(i) + 0.5F) * pitch, hook = y - 0.05F;
    const std::array<Vector3f, 4> bent = {{{x, y - 0.016F, bar + 0.045F},
                                           {x, hook + 0.01F, bar + 0.02F},
                                           {x, hook, bar + 0.022F},
                                           {x, hook - 0.008F, bar + 0.045F}}};
    m.tube(metal, bent, 0.004F, 8);
    const RandomStream r = p.random.fork(static_cast<std::uint64_t>(i));
    const double what = r.uniform(0);
    const auto long_m = bar * static_cast<float>(r.uniform(1, 0.55, 0.98));
    const Rgb8 tone = kTones[r.below(2, kTones.size())];
    if (what < 0.2) continue;
    p.part(fmt::format("thing_{}", i + 1), what < 0.75 ? "clothes" : "bag");
    if (what < 0.45 && i > 0 && i + 1 < n) {  // a coat
      m.push(translation(0, y - 0.06F, 0));
      garment(p, p.fixed(plain("fabric", tone, 0.4, 112)), x, bar + 0.01F,
              {std::min(0.75F, long_m), 1.5F * pitch, 0.08F, false});
      m.pop();
    } else if (what < 0.75) {  // an apron or a scarf, gathered at the hook
      m.sheet(p.fixed(plain(r.uniform(3) < 0.5 ? "curtain_fabric" : "fabric", tone, 0.5,
                            113 + r.below(4, 90))),
              [&](float s, float t) -> Vector3f {
                const float open = 0.15F + 0.85F * std::sqrt(t);
                const float fold = 0.014F * std::sin(19.0F * s) * (1.0F - 0.4F * t);
                return {x + (s - 0.5F) * 0.92F * pitch * open, hook - 0.004F + fold,
                        bar + 0.03F - t * long_m};
              },
              20, 14, {pitch, long_m});
    } else {  // a bag on its strap
      const MaterialId stuff = p.fixed(plain("leather", tone, 0.4, 114));
      const float tall = std::min(0.30F, 0.5F * bar), top = bar + 0.02F - 0.45F * long_m;
      const float low = std::max(0.01F, top - tall), half = 0.42F * pitch;
      m.cushion(stuff, {x, hook, 0.5F * (low + top)}, {2 * half, 0.075F, top - low}, 0.025F);
      for (const float s : {-1.0F, 1.0F}) {
        const std::array<Vector3f, 3> strap = {{{x + 0.9F * s * half, hook, top - 0.03F},
                                                {x + 0.5F * s * half, hook, 0.5F * (top + bar)},
                                                {x, hook, bar + 0.025F}}};
        m.tube(stuff, strap, 0.005F, 6);
      }
    }
    p.body();
  }
}

void bag(Piece& p) {
  const float w = p.size_m.x(), d = p.size_m.y(), h = p.size_m.z();
  const MaterialId body = p.material("body", plain("leather", {120, 78, 50}, 0.5, 72));
  const MaterialId metal = p.fixed(plain("brushed_metal", {190, 160, 90}, 0.3, 9));
  MeshBuilder& m = p.mesh;
  const float tall = 0.68F * h;
  m.sheet(body,
          [&](float s, float t) -> Vector3f {  // a tapering body with soft sides
            const float a = 6.2831853F * s;
            const float taper = 0.86F + 0.14F * t;
            const float ca = std::cos(a), sa = std::sin(a);
            const float x =
                (ca > 0 ? 1.0F : -1.0F) * std::pow(std::abs(ca), 0.5F) * 0.5F * w * taper;
            const float y = (sa > 0 ? 1.0F : -1.0F) * std::pow(std::abs(sa), 0.6F) * 0.5F * d *
                            (0.35F + 0.65F * t);
            return {x, y, tall * (1.0F - t)};
          },
          32, 8, {2 * w, h});
  m.box(body, {-0.46F * w, -0.45F * d, 0.001F}, {0.46F * w, 0.45F * d, 0.012F});
  m.box(body, {-0.40F * w, -0.16F * d, tall - 0.02F}, {0.40F * w, 0.16F * d, tall - 0.006F});
  for (const float sy : {-1.0F, 1.0F}) {
    std::vector<Vector3f> grip;
    for (int i = 0; i <= 10; ++i) {
      const float a = 3.14159265F * static_cast<float>(i) / 10.0F;
      grip.emplace_back(0.24F * w * std::cos(a), sy * 0.18F * d,
                        tall - 0.05F + (h - tall + 0.045F) * std::sin(a));
    }
    m.tube(body, grip, 0.007F, 8);
  }
  m.box(metal, {-0.02F, -0.42F * d, 0.52F * h}, {0.02F, -0.30F * d, 0.57F * h},
        {.bevel_m = 0.001F});
}

}  // namespace mh::build
