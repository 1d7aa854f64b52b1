// SPDX-License-Identifier: Apache-2.0
// Round, soft and bent shapes.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <numbers>

#include "scenes/mesh_builder.hpp"

namespace mh {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kTau = 2.0F * std::numbers::pi_v<float>;

/// Point k of n on the unit circle; point n is exactly point 0, so that rings close without a
/// crack.
Vector2f on_circle(int k, int n) {
  const float angle = kTau * static_cast<float>(k % n) / static_cast<float>(n);
  return {std::cos(angle), std::sin(angle)};
}

/// Two unit vectors perpendicular to a unit direction; (first, second, way) is right-handed.
std::pair<Vector3f, Vector3f> across(const Vector3f& way) {
  const Vector3f helper = std::abs(way.z()) < 0.9F ? Vector3f::UnitZ() : Vector3f::UnitX();
  const Vector3f first = helper.cross(way).normalized();
  return {first, way.cross(first)};
}

/// Projects a welded soft shape to a plane, without a seam and such that no face is edge-on.
Vector2f soft_uv(const Vector3f& p) {
  return {p.x() + 0.6F * p.z(), p.y() + 0.6F * p.z()};
}

}  // namespace

void MeshBuilder::disc(MaterialId material, const Vector3f& center,
                       const std::vector<Vector3f>& ring, bool flip) {
  const auto [a, b] = across((ring[1] - ring[0]).cross(ring[2] - ring[1]).normalized());
  const auto uv = [a = a, b = b, &center](const Vector3f& p) {
    return Vector2f((p - center).dot(a), (p - center).dot(b));
  };
  const std::uint32_t middle = vertex(material, center, {0, 0});
  std::vector<std::uint32_t> rim;
  for (const Vector3f& p : ring) rim.push_back(vertex(material, p, uv(p)));
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const std::uint32_t p = rim[k], q = rim[(k + 1) % rim.size()];
    if (flip)
      triangle(material, middle, q, p);
    else
      triangle(material, middle, p, q);
  }
}

void MeshBuilder::cylinder(MaterialId material, const Vector3f& a, const Vector3f& b,
                           const EndRadii& radii, int sides, bool caps) {
  const float length = (b - a).norm();
  const Vector3f way = (b - a) / length;
  const auto [x, y] = across(way);
  const int n = cells(length);
  const auto point = [&, x = x, y = y](int k, float t) -> Vector3f {
    const Vector2f c = on_circle(k, sides);
    const float r = radii.a_m + (radii.b_m - radii.a_m) * t;
    return a + t * (b - a) + r * (c.x() * x + c.y() * y);
  };
  Grid grid;  // u runs along the axis, as the grain of a turned leg does
  for (int k = 0; k <= sides; ++k)
    for (int i = 0; i <= n; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(n);
      const float round =
          kTau * std::max(radii.a_m, radii.b_m) * static_cast<float>(k) / static_cast<float>(sides);
      grid.push_back(vertex(material, point(k, t), {t * length, round}));
    }
  grid_faces(material, grid, n, sides, true);
  if (!caps) return;
  for (const bool top : {false, true}) {
    if ((top ? radii.b_m : radii.a_m) <= 0.0F) continue;
    std::vector<Vector3f> ring;
    for (int k = 0; k < sides; ++k) ring.push_back(point(k, top ? 1.0F : 0.0F));
    disc(material, top ? b : a, ring, !top);
  }
}

void MeshBuilder::lathe(MaterialId material, const Vector3f& center,
                        std::span<const Vector2f> profile, int sides) {
  float widest = 0.0F;
  for (const Vector2f& p : profile) widest = std::max(widest, p.x());
  Grid grid;
  float way = 0.0F;
  for (std::size_t j = 0; j < profile.size(); ++j) {
    if (j > 0) way += (profile[j] - profile[j - 1]).norm();
    for (int k = 0; k <= sides; ++k) {
      const Vector2f c = on_circle(k, sides) * profile[j].x();
      const float round = kTau * widest * static_cast<float>(k) / static_cast<float>(sides);
      grid.push_back(
          vertex(material, center + Vector3f(c.x(), c.y(), profile[j].y()), {round, -way}));
    }
  }
  grid_faces(material, grid, sides, static_cast<int>(profile.size()) - 1, false);
}

void MeshBuilder::tube(MaterialId material, std::span<const Vector3f> points, float radius_m,
                       int sides) {
  const std::vector<float> radii(points.size(), radius_m);
  tube(material, points, radii, sides);
}

void MeshBuilder::tube(MaterialId material, std::span<const Vector3f> points,
                       std::span<const float> radii_m, int sides) {
  assert(points.size() >= 2 && radii_m.size() == points.size());
  const std::size_t n = points.size();
  Vector3f x = across((points[1] - points[0]).normalized()).first;
  Grid grid;
  std::vector<Vector3f> first_ring, last_ring;
  float way = 0.0F;
  for (std::size_t j = 0; j < n; ++j) {
    const Vector3f& before = points[j > 0 ? j - 1 : 0];
    const Vector3f& after = points[j + 1 < n ? j + 1 : n - 1];
    const Vector3f along = (after - before).normalized();
    x = (x - along * along.dot(x)).normalized();  // parallel transport: the tube does not twist
    const Vector3f y = along.cross(x);
    if (j > 0) way += (points[j] - points[j - 1]).norm();
    for (int k = 0; k <= sides; ++k) {
      const Vector2f c = on_circle(k, sides) * radii_m[j];
      const Vector3f p = points[j] + c.x() * x + c.y() * y;
      if (k < sides && j == 0) first_ring.push_back(p);
      if (k < sides && j == n - 1) last_ring.push_back(p);
      grid.push_back(
          vertex(material, p,
                 {way, kTau * radii_m[0] * static_cast<float>(k) / static_cast<float>(sides)}));
    }
  }
  grid_faces(material, grid, sides, static_cast<int>(n) - 1, false);
  if (radii_m.front() > 1e-4F) disc(material, points.front(), first_ring, true);
  if (radii_m.back() > 1e-4F) disc(material, points.back(), last_ring, false);
}

void MeshBuilder::cushion(MaterialId material, const Vector3f& center, const Vector3f& size_m,
                          float radius_m, float bulge_m, float edge_m) {
  const Vector3f half = 0.5F * size_m;
  const float radius = std::min(radius_m, half.minCoeff());
  const Vector3f core = half - Vector3f::Constant(radius);
  std::array<int, 3> n{};
  for (int k = 0; k < 3; ++k)
    n[static_cast<std::size_t>(k)] =
        std::max(size_m[k] < 0.3F ? 4 : 6, static_cast<int>(std::ceil(size_m[k] / edge_m)));
  // Points of the lattice on the surface of a cube, each made once (welded).
  std::map<std::array<int, 3>, std::uint32_t> welded;
  const auto lattice = [&](const std::array<int, 3>& i) {
    const auto found = welded.find(i);
    if (found != welded.end()) return found->second;
    Vector3f cube;  // closer lines near the edges, where the surface bends
    for (int k = 0; k < 3; ++k) {
      const float t = 2.0F * static_cast<float>(i[static_cast<std::size_t>(k)]) /
                          static_cast<float>(n[static_cast<std::size_t>(k)]) -
                      1.0F;
      cube[k] = half[k] * std::sin(t * kTau / 4.0F * 0.8F) / std::sin(kTau / 4.0F * 0.8F);
    }
    const Vector3f inner = cube.cwiseMax(-core).cwiseMin(core);
    const Vector3f out = cube - inner;
    Vector3f p = inner + out.normalized() * radius;
    if (out.norm() < 1e-6F) p = cube;
    const Vector3f share = p.cwiseQuotient(half);
    p.z() += bulge_m * share.z() * (1.0F - share.x() * share.x()) * (1.0F - share.y() * share.y());
    const std::uint32_t id = vertex(material, center + p, soft_uv(p + center));
    welded.emplace(i, id);
    return id;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const bool high : {false, true}) {
      const auto a = static_cast<std::size_t>((axis + 1) % 3);
      const auto b = static_cast<std::size_t>((axis + 2) % 3);
      Grid grid;
      for (int j = 0; j <= n[b]; ++j)
        for (int i = 0; i <= n[a]; ++i) {
          std::array<int, 3> at{};
          at[static_cast<std::size_t>(axis)] = high ? n[static_cast<std::size_t>(axis)] : 0;
          at[a] = i;
          at[b] = j;
          grid.push_back(lattice(at));
        }
      grid_faces(material, grid, n[a], n[b], !high);
    }
}

void MeshBuilder::sheet(MaterialId material, const std::function<Vector3f(float, float)>& point,
                        int nu, int nv, const Vector2f& size_m) {
  Grid grid;
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) {
      const float s = static_cast<float>(i) / static_cast<float>(nu);
      const float t = static_cast<float>(j) / static_cast<float>(nv);
      grid.push_back(vertex(material, point(s, t), {s * size_m.x(), t * size_m.y()}));
    }
  grid_faces(material, grid, nu, nv, true);
}

void MeshBuilder::leaf(MaterialId material, const Vector3f& root, const Vector3f& way,
                       float length_m, float width_m, float droop) {
  Vector3f side = way.cross(Vector3f::UnitZ());
  side = side.norm() < 0.05F ? Vector3f::UnitX() : Vector3f(side.normalized());
  const Vector3f up = side.cross(way).normalized();
  constexpr int kStations = 6;
  Grid grid;
  for (int j = 0; j <= kStations; ++j) {
    const float t = static_cast<float>(j) / kStations;
    const Vector3f spine = root + length_m * (t * way - droop * t * t * Vector3f::UnitZ());
    // Widest at 40 % of the length; a small width at the ends avoids degenerate faces.
    const float half =
        0.5F * width_m * std::max(0.04F, std::pow(std::sin(kTau / 2 * std::pow(t, 0.76F)), 0.8F));
    for (int i = -1; i <= 1; ++i) {
      const float fold = i == 0 ? 0.0F : 0.25F * half;  // a keel along the middle
      const Vector3f p = spine + static_cast<float>(i) * half * side + fold * up;
      grid.push_back(
          vertex(material, p, {t * length_m, 0.5F * width_m + half * static_cast<float>(i)}));
    }
  }
  grid_faces(material, grid, 2, kStations, true);
}

}  // namespace mh
