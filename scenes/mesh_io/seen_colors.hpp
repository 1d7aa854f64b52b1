// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scenes/scene.hpp"

namespace mh {

/// Linear color of a repeating texture, bilinear between texel centers.
Eigen::Vector3f sample_texture(const Grid2d<Rgb8>& texture, const Eigen::Vector2f& uv);

/// Splits faces finely enough for vertex colors: where a texture or baked light shows, no edge is
/// longer than max_edge_m (0 = unchanged); other faces stay.
Scene split_for_colors(const Scene& scene, float max_edge_m);

/// The visible color at each vertex, sRGB: texture x base color x vertex color x baked light, plus
/// emission. A vertex with several materials takes that of its first face.
std::vector<Rgb8> seen_colors(const Scene& scene);

}  // namespace mh
