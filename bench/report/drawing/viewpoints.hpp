// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scenes/scene.hpp"
#include "sim/render/renderer.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// Returns views (world_from_camera) that together show the contents of a scene without a plan, as
/// seen by a person who stands on its free floor or, if there is none, walks around the scene.
/// Candidates are rendered at low resolution. One after another, the view is chosen that adds the
/// most to what the earlier ones show: mainly objects, then surface.
/// @param camera  the lens; the size of its images does not matter
/// @returns at least one view, at most `most`
std::vector<SE3> viewpoints(const Scene& scene, const Renderer& renderer, const Camera& camera,
                            std::size_t most);

}  // namespace mh
