// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_builder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "slam/core/random.hpp"

namespace mh {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kThinnestBevelled = 0.017F;
constexpr float kTau = 2.0F * std::numbers::pi_v<float>;

/// Point k of n on the unit circle; k = n is exactly k = 0, so that rings close without a crack.
Vector2f on_circle(int k, int n) {
  const float angle = kTau * static_cast<float>(k % n) / static_cast<float>(n);
  return {std::cos(angle), std::sin(angle)};
}

/// Two unit vectors across a unit direction; (first, second, way) is right-handed.
std::pair<Vector3f, Vector3f> across(const Vector3f& way) {
  const Vector3f helper = std::abs(way.z()) < 0.9F ? Vector3f::UnitZ() : Vector3f::UnitX();
  const Vector3f first = helper.cross(way).normalized();
  return {first, way.cross(first)};
}

/// Projects a welded soft shape to the plane without a seam: no face that occurs is edge-on.
Vector2f soft_uv(const Vector3f& p) {
  return {p.x() + 0.6F * p.z(), p.y() + 0.6F * p.z()};
}

}  // namespace

std::vector<float> breaks(float a, float b, float step, std::vector<float> stops) {
  std::erase_if(stops, [&](float s) { return s <= a + 1e-5F || s >= b - 1e-5F; });
  stops.push_back(a);
  stops.push_back(b);
  std::sort(stops.begin(), stops.end());
  stops.erase(std::unique(stops.begin(), stops.end(),
                          [](float x, float y) { return std::abs(x - y) < 1e-5F; }),
              stops.end());
  std::vector<float> result{stops.front()};
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const float from = stops[i - 1], to = stops[i];
    const int n = std::max(1, static_cast<int>(std::ceil((to - from) / step - 1e-4F)));
    for (int k = 1; k < n; ++k)
      result.push_back(from + (to - from) * static_cast<float>(k) / static_cast<float>(n));
    result.push_back(to);
  }
  return result;
}

Eigen::Isometry3f translation(float x, float y, float z) {
  return Eigen::Isometry3f(Eigen::Translation3f(x, y, z));
}

Eigen::Isometry3f turn(const Vector3f& axis, float angle_rad) {
  return Eigen::Isometry3f(Eigen::AngleAxisf(angle_rad, axis));
}

Eigen::Isometry3f turn_z(float angle_rad) {
  return turn(Vector3f::UnitZ(), angle_rad);
}

MaterialId MeshBuilder::material(const MaterialSpec& spec, const Vector3f& emission) {
  const std::string key =
      fmt::format("{}|{}|{},{},{}|{}|{}|{},{}|{},{},{}", spec.name, spec.kind, spec.tone.r,
                  spec.tone.g, spec.tone.b, spec.variation, spec.seed, spec.size_m.x(),
                  spec.size_m.y(), emission.x(), emission.y(), emission.z());
  const auto [found, is_new] =
      materials_.try_emplace(key, static_cast<MaterialId>(scene_.materials.size()));
  if (is_new) {
    validate(spec);
    scene_.materials.push_back(painted ? make_material(spec) : Material{});
    scene_.materials.back().emission = emission;
  }
  return found->second;
}

InstanceId MeshBuilder::begin_instance(const std::string& name, ClassId class_id) {
  const auto id = static_cast<InstanceId>(scene_.instances.size() + 1);
  Instance instance;
  instance.id = id;
  instance.class_id = class_id;
  instance.name = name;
  scene_.instances.push_back(instance);
  resume_instance(id);
  return id;
}

void MeshBuilder::resume_instance(InstanceId id) {
  assert(id <= scene_.instances.size());
  instance_ = id;
  class_ = id == 0 ? kVoid : scene_.instances[id - 1].class_id;
}

void MeshBuilder::push(const Eigen::Isometry3f& outer_from_inner) {
  frames_.push_back(frames_.back() * outer_from_inner);
}

void MeshBuilder::pop() {
  assert(frames_.size() > 1);
  frames_.pop_back();
}

std::uint32_t MeshBuilder::vertex(MaterialId material, const Vector3f& local, const Vector2f& uv) {
  scene_.positions_m.emplace_back(frames_.back() * local);
  scene_.uvs.push_back(uv);
  material_of_vertex_.push_back(material);
  return static_cast<std::uint32_t>(scene_.positions_m.size() - 1);
}

void MeshBuilder::triangle(MaterialId material, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const Vector3f &pa = scene_.positions_m[a], &pb = scene_.positions_m[b],
                 &pc = scene_.positions_m[c];
  // At the poles of round shapes two corners fall together; leaving such a face out opens nothing.
  if ((pb - pa).cross(pc - pa).norm() < 1e-9F) return;
  scene_.triangles.push_back({a, b, c});
  scene_.material_of.push_back(material);
  scene_.class_of.push_back(class_);
  scene_.instance_of.push_back(instance_);
}

void MeshBuilder::grid_faces(MaterialId material, const Grid& grid, int nu, int nv, bool flip) {
  const auto at = [&](int i, int j) { return grid[static_cast<std::size_t>(j * (nu + 1) + i)]; };
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      const std::uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      if (flip) {
        triangle(material, a, c, b);
        triangle(material, a, d, c);
      } else {
        triangle(material, a, b, c);
        triangle(material, a, c, d);
      }
    }
}

int MeshBuilder::cells(float length_m) const {
  return std::max(1, static_cast<int>(std::ceil(length_m * detail / max_edge_m - 1e-4F)));
}

void MeshBuilder::box(MaterialId material, const Vector3f& min_m, const Vector3f& max_m,
                      const BoxStyle& style) {
  const Vector3f size = max_m - min_m;
  assert(size.minCoeff() > 0.0F);
  // Thin bars are left sharp: their bevel would be far below a pixel and cost four times the
  // points.
  const float bevel = size.minCoeff() < kThinnestBevelled ? 0.0F : style.bevel_m;
  int grain = style.grain_axis;
  if (grain < 0) size.maxCoeff(&grain);
  // Every box is cut from another place of the stuff.
  const RandomStream random = RandomStream(scene_.instances.size()).fork(shape_count_++);
  const Vector2f offset(static_cast<float>(random.uniform(0)),
                        static_cast<float>(random.uniform(1)));

  // Breaks per axis inside the bevel, shared by faces and bevels.
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

void MeshBuilder::picture(MaterialId material, const Vector3f& corner, const Vector3f& right,
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

void MeshBuilder::panel(MaterialId material, const Vector3f& origin, const Vector3f& u_axis,
                        const Vector3f& v_axis, std::span<const float> u_breaks,
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
        // v grows downwards in the picture, upwards on the wall: turn it round.
        id[j * nu + i] = vertex(material, origin + u_breaks[i] * u_axis + v_breaks[j] * v_axis,
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
                           float radius_a_m, float radius_b_m, int sides, bool caps) {
  const float length = (b - a).norm();
  const Vector3f way = (b - a) / length;
  const auto [x, y] = across(way);
  const int n = cells(length);
  const auto point = [&, x = x, y = y](int k, float t) -> Vector3f {
    const Vector2f c = on_circle(k, sides);
    const float r = radius_a_m + (radius_b_m - radius_a_m) * t;
    return a + t * (b - a) + r * (c.x() * x + c.y() * y);
  };
  Grid grid;  // u runs along the axis, as the grain of a turned leg does
  for (int k = 0; k <= sides; ++k)
    for (int i = 0; i <= n; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(n);
      const float round = kTau * std::max(radius_a_m, radius_b_m) * static_cast<float>(k) /
                          static_cast<float>(sides);
      grid.push_back(vertex(material, point(k, t), {t * length, round}));
    }
  grid_faces(material, grid, n, sides, true);
  if (!caps) return;
  for (const bool top : {false, true}) {
    if ((top ? radius_b_m : radius_a_m) <= 0.0F) continue;
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
    x = (x - along * along.dot(x)).normalized();  // carried along: the tube does not twist
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
    // Widest at 40 % of the length; a small width at the ends keeps the faces sound.
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

Scene MeshBuilder::finish() {
  for (std::size_t i = 0; i < scene_.uvs.size(); ++i)
    scene_.uvs[i] = scene_.uvs[i].cwiseQuotient(scene_.materials[material_of_vertex_[i]].tile_m);
  std::vector<char> seen(scene_.instances.size() + 1, 0);
  for (std::size_t f = 0; f < scene_.triangles.size(); ++f) {
    const InstanceId id = scene_.instance_of[f];
    if (id == 0) continue;
    Instance& instance = scene_.instances[id - 1];
    for (const std::uint32_t v : scene_.triangles[f]) {
      const Vector3f& p = scene_.positions_m[v];
      if (!seen[id]) instance.min_m = instance.max_m = p;
      seen[id] = 1;
      instance.min_m = instance.min_m.cwiseMin(p);
      instance.max_m = instance.max_m.cwiseMax(p);
    }
  }
  return std::move(scene_);
}

}  // namespace mh
