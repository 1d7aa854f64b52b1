// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include "scenes/furniture/builders.hpp"

namespace mh::build {

using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

/// A pot with soil; returns the height of the soil.
float pot(Piece& p, float radius, float height) {
  const MaterialId clay = p.material("pot", plain("ceramic", {186, 174, 158}, 0.3, 111));
  const MaterialId earth = p.fixed(plain("carpet", {70, 52, 38}, 0.6, 112));
  const std::array<Vector2f, 7> profile = {{{0.001F, 0},
                                            {0.72F * radius, 0},
                                            {0.95F * radius, 0.85F * height},
                                            {radius, 0.86F * height},
                                            {radius, height},
                                            {0.90F * radius, height},
                                            {0.87F * radius, 0.88F * height}}};
  p.mesh.lathe(clay, {0, 0, 0}, profile, 22);
  const std::array<Vector2f, 3> soil = {{{0.88F * radius, 0.89F * height},
                                         {0.4F * radius, 0.92F * height},
                                         {0.001F, 0.93F * height}}};
  p.mesh.lathe(earth, {0, 0, 0}, soil, 14);
  return 0.92F * height;
}

MaterialId foliage(Piece& p, Rgb8 tone, float length, float width, std::uint64_t seed) {
  MaterialSpec spec = plain("foliage", tone, 0.5, seed);
  spec.size_m = {length, width};
  return p.material("leaves", spec);
}

}  // namespace

void plant_tall(Piece& p) {
  const float r = 0.5F * p.size_m.x(), h = p.size_m.z();
  const float earth = pot(p, 0.42F * p.size_m.x() * 0.85F, std::min(0.32F, 0.26F * h));
  const MaterialId bark = p.fixed(plain("bark", {112, 88, 64}, 0.5, 113));
  const float length = 0.72F * r + 0.015F, width = 0.52F * length;
  const MaterialId leaves = foliage(p, {72, 122, 62}, length, width, 114);
  MeshBuilder& m = p.mesh;
  // Two stems with leaves in a spiral, like a rubber fig's.
  for (int stem = 0; stem < 2; ++stem) {
    const RandomStream random = p.random.fork(static_cast<std::uint64_t>(stem));
    const float top = h - (stem == 0 ? 0.10F : 0.28F * (h - earth)),
                side = stem == 0 ? 0.02F : -0.05F;
    const auto axis = [&](float t) -> Vector3f {
      return {side + 0.06F * (stem == 0 ? 1.0F : -1.0F) * t * t, side + 0.03F * std::sin(3.0F * t),
              earth - 0.02F + t * (top - earth + 0.02F)};
    };
    std::vector<Vector3f> points;
    std::vector<float> radii;
    for (int i = 0; i <= 10; ++i) {
      points.push_back(axis(static_cast<float>(i) / 10.0F));
      radii.push_back(0.014F - 0.0009F * static_cast<float>(i));
    }
    m.tube(bark, points, radii, 8);
    const int n = static_cast<int>((top - earth) / 0.036F);
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<std::uint64_t>(i);
      const float t = 0.18F + 0.82F * (static_cast<float>(i) + 0.5F) / static_cast<float>(n);
      const float angle =
          2.39996F * static_cast<float>(i) + static_cast<float>(random.uniform(4 * k, -0.3, 0.3));
      const float rise =
          0.35F + 0.75F * t + static_cast<float>(random.uniform(4 * k + 1, -0.15, 0.15));
      const Vector3f way = Vector3f(std::cos(angle), std::sin(angle), rise).normalized();
      const float scale =
          static_cast<float>(random.uniform(4 * k + 2, 0.75, 1.0)) * (t > 0.93F ? 0.6F : 1.0F);
      const Vector3f root = axis(t) + 0.03F * way;
      const std::array<Vector3f, 2> stalk = {axis(t), root};
      m.tube(bark, stalk, 0.003F, 5);
      m.leaf(leaves, root, way, scale * length, scale * width,
             static_cast<float>(random.uniform(4 * k + 3, 0.45, 0.95)));
    }
  }
}

void plant_bushy(Piece& p) {
  const float r = 0.5F * p.size_m.x(), h = p.size_m.z();
  const float tall = std::min(0.36F * h, 1.1F * r);
  const float earth = pot(p, std::min(0.62F * r, 0.7F * tall + 0.03F), tall);
  const float length = 0.72F * std::hypot(r, h - earth), width = 0.17F * length;
  const MaterialId leaves = foliage(p, {86, 136, 70}, length, width, 115);
  // Long leaves that spring from the middle and arch over.
  const int n = 46;
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::uint64_t>(i);
    const float angle =
        2.39996F * static_cast<float>(i) + static_cast<float>(p.random.uniform(3 * k, -0.25, 0.25));
    const float t =
        (static_cast<float>(i) + 0.5F) / static_cast<float>(n);  // inner leaves stand up
    const float out = 0.12F + 0.88F * t;
    const float steep = (h - earth) / r * (1.55F - 0.85F * t);
    const Vector3f way =
        Vector3f(out * std::cos(angle), out * std::sin(angle), std::max(0.35F, steep)).normalized();
    // Keep within the footprint and the height.
    const float reach = std::hypot(way.x(), way.y());
    float len = length * static_cast<float>(p.random.uniform(3 * k + 1, 0.75, 1.0));
    len = std::min(len, 0.94F * r / std::max(0.2F, reach));
    const float droop = 0.25F + 0.35F * t;
    const float peak = way.z() * way.z() / (4.0F * droop) > way.z() - droop && way.z() < 2 * droop
                           ? way.z() * way.z() / (4.0F * droop)
                           : way.z() - droop;
    len = std::min(len, (h - earth - 0.01F) / std::max(0.1F, peak));
    const Vector3f root(0.10F * r * std::cos(angle), 0.10F * r * std::sin(angle), earth - 0.01F);
    p.mesh.leaf(leaves, root, way, len, width, droop);
  }
}

}  // namespace mh::build
