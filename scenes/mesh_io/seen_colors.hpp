// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scenes/scene.hpp"

namespace mh {

/// Linear color of a repeating texture, bilinear between texel centers.
Eigen::Vector3f sample_texture(const Grid2d<Rgb8>& texture, const Eigen::Vector2f& uv);

/// Splits faces finely enough for vertex colors: if the scene has textures or baked light, no edge
/// is longer than max_edge_m afterward (see subdivide). Otherwise, or if max_edge_m is 0, the scene
/// is unchanged.
Scene split_for_colors(const Scene& scene, float max_edge_m);

/// The visible color at each vertex, sRGB: texture x base color x vertex color x baked light, plus
/// emission. A vertex with several materials takes that of its first face.
std::vector<Rgb8> seen_colors(const Scene& scene);

}  // namespace mh
