// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scenes/scene.hpp"

namespace mh {

/// Linear color of a texture that repeats, bilinear between texel centers.
Eigen::Vector3f sample_texture(const Grid2d<Rgb8>& texture, const Eigen::Vector2f& uv);

/// The scene in faces small enough for colors of vertices: split until no edge is longer than
/// max_edge_m (0 = as they are) where a texture or baked light shows; the faces of others stay.
Scene split_for_colors(const Scene& scene, float max_edge_m);

/// What can be seen at each vertex, sRGB: texture x base color x vertex color x baked light, plus
/// emission. Where a vertex joins several materials, the first face counts.
std::vector<Rgb8> seen_colors(const Scene& scene);

}  // namespace mh
