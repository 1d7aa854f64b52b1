// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "scenes/scene.hpp"
#include "sim/render/renderer.hpp"

namespace mh {

struct ScanLookConfig {
  double voxel_m = 0.02;  ///< and so about the edge of a triangle, 0.005 to 0.1
  double band_m = 0.06;   ///< how far from a surface distances are kept; at least 2 voxels
  /// Of the depth's smooth error at 2 m, which grows with its square: walls come out uneven by it.
  double bump_m = 0.006;
  int least_views = 2;  ///< a voxel seen less often is a hole
  std::uint64_t seed = 0;
};

/// The scene as a hand-held scan of it would come out: what the views see, fused into a volume of
/// signed distances (Curless and Levoy, SIGGRAPH 1996) and meshed by surface nets (Gibson, MICCAI
/// 1998), with colors per vertex, rounded edges, uneven surfaces and holes where nobody looked.
/// Classes, instances and rooms are those of the scene; its light is in the colors.
/// @param renderer  of that scene
/// @throws InputError if a size is out of range, there is no view, or the views see too much for
/// the memory (600 million voxels).
Scene scan_look(const Scene& scene, const Renderer& renderer, const Camera& camera,
                std::span<const SE3> world_from_camera, const ScanLookConfig& config = {});

}  // namespace mh
