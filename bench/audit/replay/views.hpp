// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "bench/protocol/run_result.hpp"
#include "bench/protocol/world/world.hpp"
#include "slam/pipeline/slam.hpp"

namespace mh {

/// Images are at most this wide: about 12 kB each.
inline constexpr int kViewWidth_px = 320;

/// What a run saw: the image of each keyframe with its keypoints, and for each query of the first
/// parameter point its image, the candidates of Algorithm 1 at its first attempt, and the matches
/// by words with each candidate, marked as right or wrong according to the true scene. Pixel
/// coordinates refer to these images.
/// @param frozen  the run's finished map; its queries are repeated separately
nlohmann::ordered_json views_json(const RunResult& run, const World& world, SlamState& frozen);

}  // namespace mh
