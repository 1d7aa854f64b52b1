// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "scenes/scene.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/grid2d.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// RenderedFrame::faces where a pixel shows none.
inline constexpr std::uint32_t kNoFace = ~std::uint32_t{0};

/// The exact picture of a moment: no noise, no lens. All grids have the camera's size. All but the
/// color is that of the ray through the pixel's center; so is the color, unless it is smoothed
/// (Antialiasing).
struct RenderedFrame {
  Grid2d<Rgb8> color;            ///< sRGB
  Grid2d<float> depth_m;         ///< along the optical axis; 0 = nothing hit
  Grid2d<ClassId> classes;       ///< kVoid where nothing was hit
  Grid2d<InstanceId> instances;  ///< 0 where nothing was hit
  /// Linear radiance that is white in the picture is 1 / exposure; 0: the scene shows colors of
  /// its own and no light, so that nothing tells how bright it is.
  float exposure = 0.0F;

  // On request (ExtraOutputs), else empty.
  Grid2d<std::uint16_t> depth16{};  ///< 5000 per meter as in TUM's files; 0 beyond 13.1 m
  Grid2d<std::uint32_t> faces{};    ///< index in Scene::triangles; kNoFace
  Grid2d<std::array<float, 2>> barycentric{};  ///< shares of the face's corners 1 and 2
  Grid2d<Eigen::Vector3f> points_m{};          ///< world; 0 where nothing was hit
};

struct ExtraOutputs {
  bool depth16 = false;
  bool faces = false;
  bool barycentric = false;
  bool points = false;
};

/// How color becomes the mean of light over a pixel, as that of a sensor's cell is.
enum class Antialiasing {
  kNone,        ///< the ray through the center alone
  kEdges,       ///< two more rays where objects or depth have an edge; textures are filtered anyway
  kSupersample  ///< four rays in each pixel, 2 x 2
};

/// Renders one scene; implemented by ray tracing (Embree) and by rasterization (OSMesa).
class Renderer {
 public:
  virtual ~Renderer() = default;
  /// Safe to call from several threads at once; lens distortion of the camera is ignored.
  /// @throws InputError if the camera's size or focal length is out of range.
  virtual RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const = 0;
};

/// What both renderers refuse: a size or focal length out of range. The principal point may lie
/// anywhere: a rolling shutter renders strips of a picture, most of which do not hold it.
/// @throws InputError naming the field.
inline void check_projection(Camera camera) {
  camera.cx_px = camera.cy_px = 0;
  validate(camera);
}

struct RenderConfig {
  int threads = 1;        ///< threads over tiles of one picture; never changes a bit of it
  float exposure = 1.0F;  ///< linear radiance that maps to white is 1 / exposure
  Antialiasing antialiasing = Antialiasing::kEdges;
  ExtraOutputs extra{};
  bool portable = false;  ///< pin Embree to AVX2, so that pictures agree across processors
};

/// Ray-traces with Embree. Keeps no reference to the scene.
std::unique_ptr<Renderer> make_embree_renderer(const Scene& scene, const RenderConfig& config = {});

/// Rasterizes with OSMesa: the independent oracle. Shows the centers of pixels only (kNone) and no
/// extra outputs; `threads` and `portable` mean nothing to it. Pictures are made one at a time.
/// Keeps no reference to the scene.
/// @throws MachineError if this build or this machine has no OSMesa.
std::unique_ptr<Renderer> make_osmesa_renderer(const Scene& scene, const RenderConfig& config = {});

/// By name: "embree" or "osmesa". @throws InputError on another name.
std::unique_ptr<Renderer> make_renderer(std::string_view name, const Scene& scene,
                                        const RenderConfig& config = {});

}  // namespace mh
