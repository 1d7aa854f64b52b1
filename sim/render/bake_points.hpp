// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "scenes/scene.hpp"

namespace mh {

/// Positions and directions at which the light of each vertex is sampled: not at the vertex itself,
/// which may be in a corner or on the edge of a shadow, but spread over its faces, up to halfway to
/// the opposite edge.
class BakePoints {
 public:
  explicit BakePoints(const Scene& scene);

  std::size_t size() const { return normals_.size(); }
  /// Unit normal, the area-weighted mean of the faces' normals; z if the faces have no area.
  const Eigen::Vector3f& normal(std::size_t vertex) const { return normals_[vertex]; }
  /// Sample i of the positions where a vertex's light is sampled, lifted off the surface to the
  /// normal's side (side = 1) or the other one (-1). `shift` in [0, 1) varies the pattern.
  Eigen::Vector3f origin_m(std::size_t vertex, int i, float shift, float side) const;

 private:
  const Scene& scene_;
  std::vector<Eigen::Vector3f> normals_;
  std::vector<std::size_t> begin_;      // start of each vertex's corners in faces_
  std::vector<std::uint32_t> faces_;    // face x 4 + corner
  std::vector<Eigen::Vector3f> lifts_;  // by face: a small offset off its surface
};

/// The vertices that share an edge with each vertex, ascending.
class VertexNeighbors {
 public:
  explicit VertexNeighbors(const Scene& scene);
  std::span<const std::uint32_t> of(std::size_t vertex) const {
    return {neighbors_.data() + begin_[vertex], begin_[vertex + 1] - begin_[vertex]};
  }

 private:
  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> neighbors_;
};

}  // namespace mh
