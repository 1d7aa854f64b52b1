// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/config/setting.hpp"

namespace mh {

struct FeatureConfig {
  int count = 1000;            ///< keypoints per frame, at most
  int levels = 8;              ///< pyramid levels
  double scale = 1.2;          ///< ratio of the image sizes of successive levels
  int fast_threshold = 20;     ///< gray levels
  int fast_threshold_low = 7;  ///< used in cells where the first threshold finds nothing
  double max_depth_m = 8.0;    ///< larger depths are dropped
  friend bool operator==(const FeatureConfig&, const FeatureConfig&) = default;
};

template <MaybeConst<FeatureConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [count, levels, scale, fast_threshold, fast_threshold_low, max_depth_m] = c;
  v("count", count, {10, 20000}, "keypoints wanted per frame");
  v("levels", levels, {1, 16}, "levels of the image pyramid");
  v("scale", scale, {1.01, 2}, "scale factor between levels");
  v("fast_threshold", fast_threshold, setting::kGray, "gray levels");
  v("fast_threshold_low", fast_threshold_low, setting::kGray,
    "used where the first threshold finds nothing");
  v("max_depth_m", max_depth_m, {0.1, 1000}, "larger depths are dropped");
}

}  // namespace mh
