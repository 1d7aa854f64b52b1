// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "slam/pipeline/prepared_frame.hpp"
#include "slam/relocalize/relocalize.hpp"
#include "slam/track/dead_reckon.hpp"

namespace mh {

/// The context for one frame's step; matches are counted in its report.
SlamContext context_of(const SlamState& state, const StepObservers& observers, StepReport& report);

/// What mapping knows about a frame before it is located.
struct KnownBefore {
  IsPossible is_possible = {};            ///< whether a pose from the image is possible
  std::optional<MapPose> earlier_pose{};  ///< where the frame was before a rewind
};

/// Localizes a frame in the map: by tracking from previous frames; if that fails, by
/// relocalization. Reads the map, never writes it; only the tracker's stale_scores changes.
std::optional<Located> locate(const SlamState& state, Tracker& tracker, PreparedFrame& frame,
                              RandomStream stream, const StepObservers& observers,
                              StepReport& report, const KnownBefore& known = {});

/// Refines a pose against the local map.
/// @param origin  of the piece of the map that the pose is in
/// @returns nullopt with fewer than `min_inliers` inliers.
std::optional<Located> confirm_in_local_map(const PreparedFrame& frame, const TrackedPose& tracked,
                                            KeyframeId origin, int min_inliers,
                                            const SlamContext& context,
                                            const StepObservers& observers);

}  // namespace mh
