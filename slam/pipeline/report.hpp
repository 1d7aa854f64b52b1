// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"
#include "slam/match/counts.hpp"
#include "slam/relocalize/outcome.hpp"

namespace mh {

enum class TrackStatus { kInitialized, kTracked, kRelocalized, kLost };
std::string_view name(TrackStatus status);

/// A loop that was closed: two keyframes and where the one is as seen from the other, by what both
/// see. For whoever knows the truth.
struct LoopClosure {
  Stamp stamp_ns = 0, old_stamp_ns = 0;  ///< of the newest keyframe and of the one recognized
  SE3 old_from_new;                      ///< old camera from new camera
};

/// All that a step hands out: plain data, no reference into the system.
struct StepReport {
  TrackStatus status = TrackStatus::kLost;
  std::optional<SE3> world_from_camera;
  int keypoints = 0;
  int inliers = 0;
  bool keyframe_added = false;
  bool loop_closed = false;
  std::optional<LoopClosure> loop;  ///< if one was closed
  RelocalizationStage relocalization = RelocalizationStage::kNone;
  std::optional<CandidateCounts> candidates;  ///< when relocalization was tried
  MatchCounts matches{};
};

}  // namespace mh
