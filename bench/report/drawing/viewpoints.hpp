// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scenes/scene.hpp"
#include "sim/render/renderer.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// Returns views (world_from_camera) that together show the contents of a scene without a plan, as
/// seen by a person who stands on its free floor, or, if it has none, who walks around it.
/// Candidates are rendered small; each chosen one shows the most that earlier ones do not: objects
/// first, then any surface.
/// @param camera  the lens; images may be of any size
/// @returns at most `most`, at least one
std::vector<SE3> viewpoints(const Scene& scene, const Renderer& renderer, const Camera& camera,
                            std::size_t most);

}  // namespace mh
