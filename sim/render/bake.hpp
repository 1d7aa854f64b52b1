// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "scenes/scene.hpp"

namespace mh {

struct BakeConfig {
  int samples = 128;     ///< hemisphere rays per vertex, rounded up to whole packets of 16
  int bounces = 2;       ///< diffuse interreflections
  int sun_samples = 16;  ///< shadow rays per sun and per lamp, rounded up in the same way
  int smoothing = 6;     ///< iterations of averaging the indirect part over neighboring vertices
  std::uint64_t seed = 0;
  int threads = 2;        ///< never changes the result
  bool portable = false;  ///< pin Embree to AVX2, so that light agrees across processors
};

/// Receives the share of the rays that have been traced, in [0, 1].
using BakeWatch = std::function<void(double)>;

/// Digest (xxh3-64) of everything that determines bake_light's result for a scene: the code's
/// version and the config without `threads`. Together with the scene's own digest, it is the key of
/// a baked scene.
std::uint64_t digest(const BakeConfig& config);

/// Computes Scene::light (irradiance / pi at every vertex, linear RGB) by ray tracing: sun through
/// windows, sphere lamps with soft shadows, sky and luminous surfaces by hemisphere rays, and
/// `bounces` diffuse interreflections gathered from the vertices' light of the previous bounce.
///
/// How vertices are handled in real-world scenes:
/// - Light is that of the side that the faces' normals point to. Only if that side gets almost no
///   light (a closed box turned inside out) is the other side's light used. Always using the
///   brighter side would let the sky shine through every thin outer wall.
/// - Light is sampled all over the vertex's faces, up to halfway to the opposite edge, so that a
///   vertex in a corner is not sampled inside the neighboring wall, and the edge of a shadow
///   becomes a ramp as wide as the faces instead of a staircase.
/// - A vertex inside something solid (furniture standing on a tessellated floor) sees mostly back
///   faces; its light is filled in from its neighbors, so that it does not darken the surrounding
///   floor.
/// - Luminous faces cast no shadow for suns and lamps (lamp shades, window panes), and near a
///   lamp's center (three radii, at least 0.3 m) their emission counts as that lamp's and is not
///   counted twice.
/// Deterministic: random numbers are keyed by (seed, vertex).
/// @param watch  may be empty; called from any thread, never from two at once
/// @throws std::invalid_argument if a count is negative or samples is 0.
void bake_light(Scene& scene, const BakeConfig& config = {}, const BakeWatch& watch = {});

/// Returns the exposure (see RenderConfig) that maps the median of visible radiance to
/// `median_radiance` (linear; 0.2 is sRGB 124). Measured with rays from places in the rooms at the
/// height of a robot's camera, up to 34 deg up and down, or from anywhere in a scene without a
/// floor plan. 1 for an empty or black scene.
float suggest_exposure(const Scene& scene, float median_radiance = 0.2F);

}  // namespace mh
