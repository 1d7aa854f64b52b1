// SPDX-License-Identifier: Apache-2.0
// Shapes with flat faces.
#include <algorithm>
#include <array>
#include <cassert>

#include "scenes/mesh_builder.hpp"
#include "slam/core/random.hpp"

namespace mh {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kThinnestBevelled = 0.017F;

}  // namespace

void MeshBuilder::box(MaterialId material, const Vector3f& min_m, const Vector3f& max_m,
                      const BoxStyle& style) {
  const Vector3f size = max_m - min_m;
  assert(size.minCoeff() > 0.0F);
  // Thin bars stay sharp: their bevel would be far below a pixel and cost four times the vertices.
  const float bevel = size.minCoeff() < kThinnestBevelled ? 0.0F : style.bevel_m;
  int grain = style.grain_axis;
  if (grain < 0) size.maxCoeff(&grain);
  // Every box is cut from a different part of the material.
  const RandomStream random = RandomStream(scene_.instances.size()).fork(shape_count_++);
  const Vector2f offset(static_cast<float>(random.uniform(0)),
                        static_cast<float>(random.uniform(1)));

  // Breaks along each axis between the bevels; used for both faces and bevels.
  std::array<std::vector<float>, 3> stops;
  for (int k = 0; k < 3; ++k) {
    const float a = min_m[k] + bevel, b = max_m[k] - bevel;
    const int n = cells(b - a);
    for (int i = 0; i <= n; ++i)
      stops[static_cast<std::size_t>(k)].push_back(
          i == n ? b : a + (b - a) * static_cast<float>(i) / static_cast<float>(n));
  }
  const auto end = [&](int axis, bool high) { return high ? max_m[axis] : min_m[axis]; };
  const auto inset = [&](int axis, bool high) {
    const auto& s = stops[static_cast<std::size_t>(axis)];
    return high ? s.back() : s.front();
  };
  const auto uv_of = [&](const Vector3f& p, int normal) -> Vector2f {
    const int a = normal == grain ? (grain + 1) % 3 : grain;
    const int b = 3 - normal - a;
    return Vector2f(p[a], p[b]) + offset;
  };

  for (int n = 0; n < 3; ++n)
    for (const bool high : {false, true}) {  // faces
      const int a = (n + 1) % 3, b = (n + 2) % 3;
      const auto &sa = stops[static_cast<std::size_t>(a)], &sb = stops[static_cast<std::size_t>(b)];
      Grid grid;
      for (const float vb : sb)
        for (const float va : sa) {
          Vector3f p;
          p[n] = end(n, high), p[a] = va, p[b] = vb;
          grid.push_back(vertex(material, p, uv_of(p, n)));
        }
      grid_faces(material, grid, static_cast<int>(sa.size()) - 1, static_cast<int>(sb.size()) - 1,
                 !high);
    }
  if (bevel <= 0.0F) return;
  for (int n = 0; n < 3; ++n) {  // bevels along axis n
    const int a = (n + 1) % 3, b = (n + 2) % 3;
    for (const bool ha : {false, true})
      for (const bool hb : {false, true}) {
        Grid grid;
        for (const bool second : {false, true})
          for (const float along : stops[static_cast<std::size_t>(n)]) {
            Vector3f p;
            p[n] = along;
            p[a] = second ? inset(a, ha) : end(a, ha);
            p[b] = second ? end(b, hb) : inset(b, hb);
            grid.push_back(vertex(material, p, uv_of(p, a)));
          }
        grid_faces(material, grid, static_cast<int>(stops[static_cast<std::size_t>(n)].size()) - 1,
                   1, ha == hb);
      }
  }
  for (int corner = 0; corner < 8; ++corner) {
    const std::array<bool, 3> h = {(corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0};
    std::array<std::uint32_t, 3> id{};
    for (int n = 0; n < 3; ++n) {
      Vector3f p;
      for (int k = 0; k < 3; ++k)
        p[k] = k == n ? end(k, h[static_cast<std::size_t>(k)])
                      : inset(k, h[static_cast<std::size_t>(k)]);
      id[static_cast<std::size_t>(n)] = vertex(material, p, uv_of(p, n));
    }
    const bool even = (h[0] + h[1] + h[2]) % 2 == 1;
    triangle(material, id[0], id[even ? 1 : 2], id[even ? 2 : 1]);
  }
}

void MeshBuilder::beam(MaterialId material, const Vector3f& a, const Vector3f& b, float width_m,
                       float depth_m, const Vector3f& side) {
  const float length = (b - a).norm();
  const Vector3f z = (b - a) / length;
  const Vector3f y = z.cross(side).normalized();
  Eigen::Isometry3f local = Eigen::Isometry3f::Identity();
  local.linear().col(0) = y.cross(z);
  local.linear().col(1) = y;
  local.linear().col(2) = z;
  local.translation() = a;
  push(local);
  box(material, {-width_m / 2, -depth_m / 2, 0}, {width_m / 2, depth_m / 2, length},
      {.bevel_m = 0.003F, .grain_axis = 2});
  pop();
}

void MeshBuilder::image(MaterialId material, const Vector3f& corner, const Vector3f& right,
                        const Vector3f& down, const Vector2f& uv0,
                        std::optional<Vector2f> uv_size) {
  const Vector2f uv = uv_size.value_or(Vector2f(right.norm(), down.norm()));
  const int nu = cells(right.norm()), nv = cells(down.norm());
  Grid grid;
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) {
      const float s = static_cast<float>(i) / static_cast<float>(nu);
      const float t = static_cast<float>(j) / static_cast<float>(nv);
      grid.push_back(
          vertex(material, corner + s * right + t * down, uv0 + Vector2f(s * uv.x(), t * uv.y())));
    }
  grid_faces(material, grid, nu, nv, true);
}

void MeshBuilder::panel(MaterialId material, const Plane& plane, std::span<const float> u_breaks,
                        std::span<const float> v_breaks,
                        const std::function<bool(float, float)>& leave_out) {
  const std::size_t nu = u_breaks.size(), nv = v_breaks.size();
  std::vector<char> kept((nu - 1) * (nv - 1), 1), used(nu * nv, 0);
  for (std::size_t j = 0; j + 1 < nv; ++j)
    for (std::size_t i = 0; i + 1 < nu; ++i) {
      const float u = 0.5F * (u_breaks[i] + u_breaks[i + 1]);
      const float v = 0.5F * (v_breaks[j] + v_breaks[j + 1]);
      if (leave_out && leave_out(u, v)) {
        kept[j * (nu - 1) + i] = 0;
        continue;
      }
      for (const std::size_t k :
           {j * nu + i, j * nu + i + 1, (j + 1) * nu + i, (j + 1) * nu + i + 1})
        used[k] = 1;
    }
  std::vector<std::uint32_t> id(nu * nv, 0);
  for (std::size_t j = 0; j < nv; ++j)
    for (std::size_t i = 0; i < nu; ++i)
      if (used[j * nu + i])
        // v grows downward in the image, upward on the wall: flip it.
        id[j * nu + i] =
            vertex(material, plane.origin + u_breaks[i] * plane.u_axis + v_breaks[j] * plane.v_axis,
                   {u_breaks[i], -v_breaks[j]});
  for (std::size_t j = 0; j + 1 < nv; ++j)
    for (std::size_t i = 0; i + 1 < nu; ++i)
      if (kept[j * (nu - 1) + i]) {
        const std::uint32_t a = id[j * nu + i], b = id[j * nu + i + 1];
        const std::uint32_t c = id[(j + 1) * nu + i + 1], d = id[(j + 1) * nu + i];
        triangle(material, a, b, c);
        triangle(material, a, c, d);
      }
}

void MeshBuilder::prism(MaterialId material, std::span<const Vector2f> outline, float z0_m,
                        float z1_m) {
  const std::size_t n = outline.size();
  Vector2f mean = Vector2f::Zero();
  for (const Vector2f& p : outline) mean += p / static_cast<float>(n);
  for (const bool top : {false, true}) {
    const float z = top ? z1_m : z0_m;
    const std::uint32_t middle = vertex(material, {mean.x(), mean.y(), z}, mean);
    std::vector<std::uint32_t> rim;
    for (const Vector2f& p : outline) rim.push_back(vertex(material, {p.x(), p.y(), z}, p));
    for (std::size_t k = 0; k < n; ++k) {
      const std::uint32_t p = rim[k], q = rim[(k + 1) % n];
      if (top)
        triangle(material, middle, p, q);
      else
        triangle(material, middle, q, p);
    }
  }
  float way = 0.0F;
  for (std::size_t k = 0; k < n; ++k) {
    const Vector2f &p = outline[k], &q = outline[(k + 1) % n];
    const float length = (q - p).norm();
    const std::uint32_t a = vertex(material, {p.x(), p.y(), z0_m}, {way, -z0_m});
    const std::uint32_t b = vertex(material, {q.x(), q.y(), z0_m}, {way + length, -z0_m});
    const std::uint32_t c = vertex(material, {q.x(), q.y(), z1_m}, {way + length, -z1_m});
    const std::uint32_t d = vertex(material, {p.x(), p.y(), z1_m}, {way, -z1_m});
    triangle(material, a, b, c);
    triangle(material, a, c, d);
    way += length;
  }
}

}  // namespace mh
