// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scenes/scene.hpp"

namespace mh {

/// What can be seen at each vertex, sRGB: texture x base colour x vertex colour x baked light, plus
/// emission. Where a vertex joins several materials, the first face counts.
std::vector<Rgb8> seen_colours(const Scene& scene);

}  // namespace mh
