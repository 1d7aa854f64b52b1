// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sim/render/packet.hpp"
#include "sim/render/renderer.hpp"

namespace mh {

inline constexpr int kEdgeBlock = 16;  ///< edges are followed within squares of so many pixels

/// The pixels of kEdgeBlock rows from y0 on at which something begins: another instance, or a jump
/// or bend of the depth. Block by block, so that those traced together lie together; the picture's
/// rim, which lacks a neighbor, is left out, and so are pictures narrower than 10 pixels.
void find_edges(const RenderedFrame& frame, int y0, std::vector<Pixel>& edges);

}  // namespace mh
