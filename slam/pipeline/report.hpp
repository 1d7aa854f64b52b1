// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "slam/core/ids.hpp"
#include "slam/core/loop_closure.hpp"
#include "slam/core/match_counts.hpp"
#include "slam/core/relocalization_stage.hpp"
#include "slam/core/se3.hpp"
#include "slam/core/track_status.hpp"
#include "slam/relocalize/candidate_counts.hpp"

namespace mh {

/// Everything that a step returns: plain data, no references into the system.
struct StepReport {
  TrackStatus status = TrackStatus::kLost;
  std::optional<SE3> world_from_camera;
  KeyframeId origin;  ///< of the piece of the map in whose world the pose is; see Keyframe
  int keypoints = 0;
  int inliers = 0;
  bool keyframe_added = false;
  bool loop_closed = false;
  std::optional<LoopClosure> loop;  ///< if one was closed
  RelocalizationStage relocalization = RelocalizationStage::kNone;
  std::optional<CandidateCounts> candidates;  ///< if relocalization was tried
  MatchCounts matches{};
};

}  // namespace mh
