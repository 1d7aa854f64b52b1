// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scenes/scene.hpp"
#include "sim/render/renderer.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// Views (world_from_camera) that together show what there is in a scene without a plan: by
/// somebody who stands on its free floor, or who walks around it where there is none. Candidates
/// are rendered small; each that is chosen shows most that those before it do not: objects first,
/// then any surface.
/// @param camera  the lens; pictures may be of any size
/// @returns at most `most`, at least one
std::vector<SE3> viewpoints(const Scene& scene, const Renderer& renderer, const Camera& camera,
                            std::size_t most);

}  // namespace mh
