// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>

#include "scenes/scene.hpp"

namespace mh {

/// The same surfaces in smaller triangles: no edge is longer than max_edge_m. Whether an edge is
/// split follows from its end points alone, so that neighbors stay joined without cracks. Texture
/// coordinates, vertex colors and light are interpolated; faces stay in order, each replaced by
/// its pieces. In a scene that knows objects, faces of none (the view outside the windows) are left
/// alone: they are large and seen from afar. @pre max_edge_m > 0.
/// @param enough_faces  once there are so many (at most four times as many) no edge is split
/// further
Scene subdivide(Scene scene, float max_edge_m,
                std::size_t enough_faces = std::numeric_limits<std::size_t>::max());

}  // namespace mh
