// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sim/render/packet.hpp"
#include "sim/render/renderer.hpp"

namespace mh {

inline constexpr int kEdgeBlock = 16;  ///< edges are grouped within squares of this many pixels

/// Finds the edge pixels of kEdgeBlock rows from y0 on: where the instance changes or the depth
/// jumps or bends. Ordered block by block, so that pixels that are traced together are close
/// together. Pixels on the image's border are left out, since they lack a neighbor, as are images
/// narrower than 10 pixels.
void find_edges(const RenderedFrame& frame, int y0, std::vector<Pixel>& edges);

}  // namespace mh
