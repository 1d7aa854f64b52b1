// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

namespace mh {

struct BakeConfig {
  int samples = 96;     ///< hemisphere rays per vertex
  int bounces = 2;      ///< indirect bounces gathered by iteration over vertices
  int sun_samples = 8;  ///< shadow rays per sun and per lamp
  std::uint64_t seed = 0;
  int threads = 2;  ///< never changes a bit of the result
};

/// Computes Scene::light (irradiance / pi at every vertex) from the scene's lights by ray tracing:
/// sun through windows, sky, lamps with soft shadows, diffuse bounces. Deterministic.
void bake_light(Scene& scene, const BakeConfig& config = {});

}  // namespace mh
