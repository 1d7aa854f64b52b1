// SPDX-License-Identifier: Apache-2.0
#include "sim/render/bake_points.hpp"

#include <algorithm>
#include <cmath>

namespace mh {
namespace {

constexpr float kLiftM = 1e-3F;  // distance off the surface: smaller than any visible gap

float fraction(float x) {
  return x - std::floor(x);
}

}  // namespace

BakePoints::BakePoints(const Scene& scene) : scene_(scene) {
  const std::size_t count = scene.positions_m.size();
  std::vector<Eigen::Vector3f> sum(count, Eigen::Vector3f::Zero());
  std::vector<Eigen::Vector3f> largest(count, Eigen::Vector3f::Zero());
  std::vector<float> area(count, 0.0F);
  begin_.assign(count + 1, 0);
  for (const auto& t : scene.triangles) {
    const Eigen::Vector3f& a = scene.positions_m[t[0]];
    const Eigen::Vector3f n = (scene.positions_m[t[1]] - a).cross(scene.positions_m[t[2]] - a);
    const float size = n.norm();
    lifts_.push_back(size > 0.0F ? Eigen::Vector3f(n * (kLiftM / size)) : Eigen::Vector3f::Zero());
    for (const std::uint32_t v : t) {
      sum[v] += n;
      area[v] += size;
      if (size > largest[v].norm()) largest[v] = n;
      ++begin_[v + 1];
    }
  }
  for (std::size_t v = 0; v < count; ++v) begin_[v + 1] += begin_[v];
  faces_.resize(begin_.back());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t f = 0; f < scene.triangles.size(); ++f)
    for (std::uint32_t k = 0; k < 3; ++k) faces_[next[scene.triangles[f][k]]++] = 4 * f + k;
  for (std::size_t v = 0; v < count; ++v) {
    // The normals of back-to-back faces cancel out; then the normal of the largest face is used.
    const bool canceled = sum[v].norm() < 0.2F * area[v];
    const Eigen::Vector3f& n = canceled ? largest[v] : sum[v];
    normals_.push_back(area[v] > 0.0F ? n.normalized() : Eigen::Vector3f::UnitZ());
  }
}

Eigen::Vector3f BakePoints::origin_m(std::size_t vertex, int i, float shift, float side) const {
  const Eigen::Vector3f& v = scene_.positions_m[vertex];
  const std::size_t count = begin_[vertex + 1] - begin_[vertex];
  if (count == 0) return v;
  const std::uint32_t entry = faces_[begin_[vertex] + static_cast<std::size_t>(i) % count];
  const auto& t = scene_.triangles[entry / 4];
  const std::uint32_t k = entry % 4;
  // The R2 sequence (Roberts 2018), folded into the triangle.
  float r = fraction(0.7548777F * static_cast<float>(i) + shift);
  float s = fraction(0.5698403F * static_cast<float>(i) + 1.618034F * shift);
  if (r + s > 1.0F) r = 1.0F - r, s = 1.0F - s;
  const Eigen::Vector3f on_face = v + 0.5F * (r * (scene_.positions_m[t[(k + 1) % 3]] - v) +
                                              s * (scene_.positions_m[t[(k + 2) % 3]] - v));
  // Samples on faces that point away from the vertex's side are lifted to that side, too.
  const Eigen::Vector3f& lift = lifts_[entry / 4];
  const float toward = lift.dot(normals_[vertex]) < 0.0F ? -side : side;
  return on_face + toward * lift;
}

VertexNeighbors::VertexNeighbors(const Scene& scene) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(scene.triangles.size() * 6);
  for (const auto& t : scene.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      edges.emplace_back(t[k], t[(k + 1) % 3]);
      edges.emplace_back(t[(k + 1) % 3], t[k]);
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  begin_.assign(scene.positions_m.size() + 1, 0);
  neighbors_.reserve(edges.size());
  for (const auto& [from, to] : edges) {
    ++begin_[from + 1];
    neighbors_.push_back(to);
  }
  for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
}

}  // namespace mh
