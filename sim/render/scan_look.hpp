// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "scenes/scene.hpp"
#include "sim/render/renderer.hpp"

namespace mh {

struct ScanLookConfig {
  double voxel_m = 0.02;  ///< about the edge length of a triangle, 0.005 to 0.1
  double band_m = 0.06;   ///< truncation distance around a surface; at least 2 voxels
  /// Smooth depth error at 2 m, which grows with the square of depth and makes walls uneven.
  double bump_m = 0.006;
  int least_views = 2;  ///< a voxel seen by fewer views is a hole
  std::uint64_t seed = 0;
};

/// Returns the scene as a handheld scan would reconstruct it: the views, fused into a signed
/// distance volume (Curless and Levoy, SIGGRAPH 1996) and meshed by surface nets (Gibson, MICCAI
/// 1998), with colors per vertex, rounded edges, uneven surfaces, and holes where no view looked.
/// Classes, instances and rooms are those of the scene; its light is baked into the colors.
/// @param renderer  renderer of `scene`
/// @throws InputError if a size is out of range, there is no view, or the views cover more than
/// fits in memory (600 million voxels).
Scene scan_look(const Scene& scene, const Renderer& renderer, const Camera& camera,
                std::span<const SE3> world_from_camera, const ScanLookConfig& config = {});

}  // namespace mh
