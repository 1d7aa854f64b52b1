// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace mh {

struct KeyframeConfig {
  int max_interval = 30;           ///< frames after which a keyframe is wanted in any case
  double min_tracked_share = 0.5;  ///< of the reference keyframe's landmarks
  int min_close_tracked = 100;     ///< close points tracked below this, and
  int min_close_new = 70;          ///< close points untracked above this: a keyframe is needed
  double close_depth_m = 3.5;      ///< depth is trusted to make a landmark at once up to here
  double redundant_share = 0.9;    ///< of a keyframe's landmarks seen by 3 others: culled
};

}  // namespace mh
