// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "bench/results/run_result.hpp"
#include "bench/results/summary.hpp"
#include "bench/world/world.hpp"

namespace mh {

/// The house from above as in the paper's Figure 5c: floor plan, occupancy map of the run beneath,
/// true and estimated path, and for each query an 'x' where the camera was and an 'o' where the
/// system believed it to be. Estimates are drawn in the frame of the dock: drift shows. Queries are
/// those of the run's first parameter point.
/// @pre world.simulated
cv::Mat draw_topdown(const World& world, const RunResult& run, QuerySet set);

}  // namespace mh
