// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sim/render/packet.hpp"
#include "sim/render/renderer.hpp"

namespace mh {

inline constexpr int kEdgeBlock = 16;  ///< edges are grouped within squares of this many pixels

/// Finds the edge pixels of kEdgeBlock rows from y0 on: where the instance changes or the depth
/// jumps or bends. Ordered block by block, so that those traced together are close together; the
/// image's border, which lacks a neighbor, is left out, as are images narrower than 10 pixels.
void find_edges(const RenderedFrame& frame, int y0, std::vector<Pixel>& edges);

}  // namespace mh
