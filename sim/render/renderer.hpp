// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "scenes/scene.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/grid2d.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// Value of RenderedFrame::faces for a pixel that shows no face.
inline constexpr std::uint32_t kNoFace = ~std::uint32_t{0};

/// The exact image at one time: no noise, no lens. All grids have the camera's size. Everything is
/// sampled by the ray through the pixel's center, except color if it is smoothed (Antialiasing).
struct RenderedFrame {
  Grid2d<Rgb8> color;            ///< sRGB
  Grid2d<float> depth_m;         ///< along the optical axis; 0 = nothing hit
  Grid2d<ClassId> classes;       ///< kVoid where nothing was hit
  Grid2d<InstanceId> instances;  ///< 0 where nothing was hit
  /// Linear radiance 1 / exposure is shown as white. 0: the scene shows its own unlit colors, so
  /// that its brightness is unknown.
  float exposure = 0.0F;

  // On request (ExtraOutputs), else empty.
  Grid2d<std::uint16_t> depth16{};  ///< 5000 per meter as in TUM's files; 0 beyond 13.1 m
  Grid2d<std::uint32_t> faces{};    ///< index in Scene::triangles, or kNoFace
  Grid2d<std::array<float, 2>> barycentric{};  ///< shares of the face's corners 1 and 2
  Grid2d<Eigen::Vector3f> points_m{};          ///< world; 0 where nothing was hit
};

struct ExtraOutputs {
  bool depth16 = false;
  bool faces = false;
  bool barycentric = false;
  bool points = false;
};

/// How color approximates the mean of light over a pixel, which a sensor cell measures.
enum class Antialiasing {
  kNone,        ///< only the ray through the center
  kEdges,       ///< two more rays at edges of objects or depth; textures are always filtered
  kSupersample  ///< four rays in each pixel, 2 x 2
};

/// Renders one scene; implemented by ray tracing (Embree) and by rasterization (OSMesa).
class Renderer {
 public:
  virtual ~Renderer() = default;
  /// Safe to call from several threads at once; lens distortion of the camera is ignored.
  /// @throws InputError if the camera's size or focal length is out of range.
  virtual RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const = 0;

  // Parts of that image, bit-identical, at less cost than the whole.

  /// The image, in which only rows first to last - 1 are defined.
  virtual RenderedFrame render_rows(const Camera& camera, const SE3& world_from_camera, int first,
                                    int last) const;
  virtual Grid2d<float> render_depth(const Camera& camera, const SE3& world_from_camera) const;
  /// The depth of some pixels.
  virtual std::vector<float> depth_at(const Camera& camera, const SE3& world_from_camera,
                                      std::span<const Eigen::Vector2i> pixels) const;
};

/// Rejects what neither renderer accepts: a size or focal length out of range. The principal point
/// may be anywhere: a rolling shutter renders strips of an image, most of which do not contain it.
/// @throws InputError naming the field.
inline void check_projection(Camera camera) {
  camera.cx_px = camera.cy_px = 0;
  validate(camera);
}

struct RenderConfig {
  int threads = 1;        ///< threads over tiles of one image; never changes the image
  float exposure = 1.0F;  ///< linear radiance that maps to white is 1 / exposure
  Antialiasing antialiasing = Antialiasing::kEdges;
  ExtraOutputs extra{};
  bool portable = false;  ///< pin Embree to AVX2, so that images agree across processors
};

/// Ray-traces with Embree. Keeps no reference to the scene.
std::unique_ptr<Renderer> make_embree_renderer(const Scene& scene, const RenderConfig& config = {});

/// Rasterizes with OSMesa: the independent oracle. Samples pixel centers only (kNone), without
/// extra outputs; ignores `threads` and `portable`. Renders one image at a time. Keeps no reference
/// to the scene.
/// @throws MachineError if this build or this machine has no OSMesa.
std::unique_ptr<Renderer> make_osmesa_renderer(const Scene& scene, const RenderConfig& config = {});

/// By name: "embree" or "osmesa". @throws InputError on another name.
std::unique_ptr<Renderer> make_renderer(std::string_view name, const Scene& scene,
                                        const RenderConfig& config = {});

}  // namespace mh
