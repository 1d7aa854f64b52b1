// SPDX-License-Identifier: Apache-2.0
#include "sim/render/renderer.hpp"

#include <fmt/format.h>

#include "slam/io/error.hpp"

namespace mh {

RenderedFrame Renderer::render_rows(const Camera& camera, const SE3& world_from_camera,
                                    int /*first*/, int /*last*/) const {
  return render(camera, world_from_camera);
}

Grid2d<float> Renderer::render_depth(const Camera& camera, const SE3& world_from_camera) const {
  return render(camera, world_from_camera).depth_m;
}

std::vector<float> Renderer::depth_at(const Camera& camera, const SE3& world_from_camera,
                                      std::span<const Eigen::Vector2i> pixels) const {
  const Grid2d<float> depth_m = render_depth(camera, world_from_camera);
  std::vector<float> depths;
  for (const Eigen::Vector2i& pixel : pixels) depths.push_back(depth_m(pixel.x(), pixel.y()));
  return depths;
}

std::unique_ptr<Renderer> make_renderer(std::string_view name, const Scene& scene,
                                        const RenderConfig& config) {
  if (name == "embree") return make_embree_renderer(scene, config);
  if (name == "osmesa") return make_osmesa_renderer(scene, config);
  throw InputError(fmt::format("renderer '{}' is not one of embree, osmesa", name));
}

}  // namespace mh
