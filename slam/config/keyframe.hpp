// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/config/setting.hpp"

namespace mh {

struct KeyframeConfig {
  int max_interval = 30;           ///< frames after which untracked close points alone call for a
                                   ///< keyframe
  double min_tracked_share = 0.5;  ///< a keyframe is needed if a smaller share of the reference
                                   ///< keyframe's landmarks is tracked
  int min_close_tracked =
      100;                 ///< a keyframe is needed if fewer close points than this are tracked and
  int min_close_new = 70;  ///< more close points than this are untracked
  double close_depth_m = 3.5;  ///< up to this depth, landmarks are created at once
  double redundant_share =
      0.9;  ///< a keyframe is culled if 3 others see this share of its landmarks
  friend bool operator==(const KeyframeConfig&, const KeyframeConfig&) = default;
};

template <MaybeConst<KeyframeConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [max_interval, min_tracked_share, min_close_tracked, min_close_new, close_depth_m,
         redundant_share] = c;
  v("max_interval", max_interval, setting::kCount,
    "frames after which untracked close points alone call for a keyframe");
  v("min_tracked_share", min_tracked_share, setting::kShare,
    "a keyframe is added if a smaller share of the reference keyframe's landmarks is tracked");
  v("min_close_tracked", min_close_tracked, {0, setting::kMany},
    "a keyframe is added if fewer close points than this are tracked and");
  v("min_close_new", min_close_new, {0, setting::kMany},
    "more close points than this are untracked");
  v("close_depth_m", close_depth_m, {0.1, 1000}, "up to this depth, landmarks are created at once");
  v("redundant_share", redundant_share, setting::kShare,
    "a keyframe is culled if 3 others see this share of its landmarks");
}

}  // namespace mh
