// SPDX-License-Identifier: Apache-2.0
#include "sim/render/renderer.hpp"

#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace mh {

std::unique_ptr<Renderer> make_renderer(std::string_view name, const Scene& scene,
                                        const RenderConfig& config) {
  if (name == "embree") return make_embree_renderer(scene, config);
  if (name == "osmesa") return make_osmesa_renderer(scene, config);
  throw InputError(fmt::format("renderer '{}' is not one of embree, osmesa", name));
}

}  // namespace mh
