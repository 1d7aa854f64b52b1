// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "bench/protocol/run_result.hpp"
#include "bench/protocol/world/world.hpp"
#include "bench/results/rows.hpp"

namespace mh {

/// Draws the house from above as in the paper's Figure 5c: the floor plan over the run's occupancy
/// map, true and estimated path, and for each query an 'x' at the camera's true position and an 'o'
/// at the estimated one. Estimates are drawn in the frame of the dock, so that drift shows. Queries
/// are those of the run's first parameter point.
/// @pre world.simulated
cv::Mat draw_topdown(const World& world, const RunResult& run, QuerySet set);

}  // namespace mh
