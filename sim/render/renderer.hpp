// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "scenes/scene.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/grid2d.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// The exact picture of a moment: no noise, no lens. All grids have the camera's size. Depth, class
/// and instance are those of the ray through the pixel's centre; so is the colour, except where a
/// renderer smooths edges.
struct RenderedFrame {
  Grid2d<Rgb8> colour;           ///< sRGB
  Grid2d<float> depth_m;         ///< along the optical axis; 0 = nothing hit
  Grid2d<ClassId> classes;       ///< kVoid where nothing was hit
  Grid2d<InstanceId> instances;  ///< 0 where nothing was hit
};

/// Renders one scene; two implementations exist or are planned (Embree, OSMesa).
class Renderer {
 public:
  virtual ~Renderer() = default;
  /// Safe to call from several threads at once; lens distortion of the camera is ignored.
  virtual RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const = 0;
};

struct RenderConfig {
  int threads = 1;        ///< threads over tiles of one picture; never changes a bit of it
  float exposure = 1.0F;  ///< linear radiance that maps to white is 1 / exposure
  /// Colours of pixels at edges (of objects and of depth) are averaged over two
  /// more rays, as a sensor's cells average light; nothing else changes.
  bool smooth_edges = true;
  bool portable = false;  ///< pin Embree to AVX2, so that pictures agree across processors
};

/// Ray-traces with Embree. Keeps no reference to the scene.
std::unique_ptr<Renderer> make_embree_renderer(const Scene& scene, const RenderConfig& config = {});

}  // namespace mh
