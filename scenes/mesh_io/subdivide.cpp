// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/subdivide.hpp"

#include <algorithm>
#include <cassert>
#include <unordered_map>

namespace mh {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Splits edges of a scene at their midpoints, each edge once.
class EdgeSplitter {
 public:
  EdgeSplitter(Scene& scene, float max_edge_m)
      : scene_(scene), max_squared_(max_edge_m * max_edge_m) {}

  bool too_long(std::uint32_t a, std::uint32_t b) const {
    return (scene_.positions_m[a] - scene_.positions_m[b]).squaredNorm() > max_squared_;
  }

  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    const std::uint64_t key = (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
    const auto [entry, is_new] =
        middles_.try_emplace(key, static_cast<std::uint32_t>(scene_.positions_m.size()));
    if (is_new) append_middle(a, b);
    return entry->second;
  }

 private:
  void append_middle(std::uint32_t a, std::uint32_t b) {
    const auto half = [&](auto& values) { values.push_back(0.5F * (values[a] + values[b])); };
    half(scene_.positions_m);
    if (!scene_.uvs.empty()) half(scene_.uvs);
    if (!scene_.light.empty()) half(scene_.light);
    if (scene_.colors.empty()) return;
    const Rgb8 p = scene_.colors[a], q = scene_.colors[b];
    const auto mean = [](int u, int v) { return static_cast<std::uint8_t>((u + v + 1) / 2); };
    scene_.colors.push_back({mean(p.r, q.r), mean(p.g, q.g), mean(p.b, q.b)});
  }

  Scene& scene_;
  float max_squared_;
  std::unordered_map<std::uint64_t, std::uint32_t> middles_;
};

/// Appends the pieces of a triangle whose long edges are split: 1, 2, 3 or 4 of them.
void split(EdgeSplitter& edges, Triangle t, std::vector<Triangle>& pieces) {
  std::array<bool, 3> long_edge;  // edge i runs from corner i to the next
  for (int i = 0; i < 3; ++i) long_edge[i] = edges.too_long(t[i], t[(i + 1) % 3]);
  const auto count = std::ranges::count(long_edge, true);
  if (count == 0) {
    pieces.push_back(t);
    return;
  }
  // Rotated so that edge 0 is split and, with two long edges, edge 2 is the short one.
  while (!long_edge[0] || (count == 2 && long_edge[2])) {
    std::ranges::rotate(t, t.begin() + 1);
    std::ranges::rotate(long_edge, long_edge.begin() + 1);
  }
  const auto [a, b, c] = t;
  const std::uint32_t ab = edges.middle(a, b);
  if (count == 1) {
    pieces.insert(pieces.end(), {{a, ab, c}, {ab, b, c}});
    return;
  }
  const std::uint32_t bc = edges.middle(b, c);
  if (count == 2) {
    pieces.insert(pieces.end(), {{ab, b, bc}, {a, ab, bc}, {a, bc, c}});
    return;
  }
  const std::uint32_t ca = edges.middle(c, a);
  pieces.insert(pieces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
}

/// Makes one pass over all faces; false if there was nothing to split.
bool split_all(Scene& scene, float max_edge_m) {
  EdgeSplitter edges(scene, max_edge_m);
  const bool keep_backdrop = !scene.instances.empty();
  Scene out;  // only its per-face arrays are used
  std::vector<Triangle> pieces;
  for (std::size_t face = 0; face < scene.triangles.size(); ++face) {
    pieces.clear();
    if (keep_backdrop && scene.instance_of[face] == 0)
      pieces.push_back(scene.triangles[face]);
    else
      split(edges, scene.triangles[face], pieces);
    for (const Triangle& piece : pieces) {
      out.triangles.push_back(piece);
      out.material_of.push_back(scene.material_of[face]);
      out.class_of.push_back(scene.class_of[face]);
      out.instance_of.push_back(scene.instance_of[face]);
    }
  }
  const bool changed = out.triangles.size() != scene.triangles.size();
  scene.triangles = std::move(out.triangles);
  scene.material_of = std::move(out.material_of);
  scene.class_of = std::move(out.class_of);
  scene.instance_of = std::move(out.instance_of);
  return changed;
}

}  // namespace

Scene subdivide(Scene scene, float max_edge_m, std::size_t enough_faces) {
  assert(max_edge_m > 0.0F);
  while (scene.triangles.size() < enough_faces && split_all(scene, max_edge_m)) {
  }
  return scene;
}

}  // namespace mh
