// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>

#include "scenes/scene.hpp"

namespace mh {

/// Subdivides surfaces into smaller triangles: no edge is longer than max_edge_m. Whether an edge
/// is split depends only on its end points, so that neighbors stay joined without cracks. Texture
/// coordinates, vertex colors and light are interpolated; faces stay in order, each replaced by its
/// pieces. In a scene with objects, faces that belong to none (the view outside the windows) are
/// not split: they are large and seen from afar. @pre max_edge_m > 0.
/// @param enough_faces  stop splitting once there are this many; the result has at most four times
///                      as many
Scene subdivide(Scene scene, float max_edge_m,
                std::size_t enough_faces = std::numeric_limits<std::size_t>::max());

}  // namespace mh
