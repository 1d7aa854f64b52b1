// SPDX-License-Identifier: Apache-2.0
#include "slam/pipeline/config.hpp"

#include <cmath>

#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace mh {

void validate(const SlamConfig& config) {
  const auto require = [](const char* field, double value, double min, double max,
                          bool open = false) {
    if (!std::isfinite(value) || value < min || value > max || (open && value == max))
      throw InputError(fmt::format("slam settings: {} = {} is outside [{}, {}{}", field, value, min,
                                   max, open ? ")" : "]"));
  };
  constexpr double kMany = 1e6;
  require("features.count", config.features.count, 10, 20000);
  require("features.levels", config.features.levels, 1, 16);
  require("features.scale", config.features.scale, 1.01, 2.0);
  require("features.fast_threshold", config.features.fast_threshold, 1, 255);
  require("features.fast_threshold_low", config.features.fast_threshold_low, 1, 255);
  require("features.max_depth_m", config.features.max_depth_m, 0.1, 1000);
  require("semantics.gamma", config.semantics.gamma, 0, kMany);
  require("semantics.xi", config.semantics.xi, 1, kMany);
  require("semantics.alpha", config.semantics.alpha, 0, 1, true);
  require("semantics.beta", config.semantics.beta, 0, 1, true);
  require("match.max_distance", config.match.max_distance, 0, 256);
  require("match.max_distance_loose", config.match.max_distance_loose, 0, 256);
  require("match.ratio", config.match.ratio, 0, 1);
  require("match.ratio_projection", config.match.ratio_projection, 0, 1);
  require("keyframe.max_interval", config.keyframe.max_interval, 1, kMany);
  require("keyframe.min_tracked_share", config.keyframe.min_tracked_share, 0, 1);
  require("keyframe.close_depth_m", config.keyframe.close_depth_m, 0.1, 1000);
  require("keyframe.redundant_share", config.keyframe.redundant_share, 0, 1);
  require("track.min_inliers", config.track.min_inliers, 4, kMany);
  require("track.min_inliers_frame", config.track.min_inliers_frame, 4, kMany);
  require("track.search_radius_px", config.track.search_radius_px, 1, 1000);
  require("track.local_radius_px", config.track.local_radius_px, 1, 1000);
  require("track.local_keyframes", config.track.local_keyframes, 1, kMany);
  require("relocalize.min_word_matches", config.relocalize.min_word_matches, 4, kMany);
  require("loop.min_gap", config.loop.min_gap, 1, kMany);
  require("loop.consecutive", config.loop.consecutive, 1, kMany);
  require("relocalize.min_inliers", config.relocalize.min_inliers, 4, kMany);
}

}  // namespace mh
