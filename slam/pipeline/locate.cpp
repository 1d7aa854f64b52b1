// SPDX-License-Identifier: Apache-2.0
#include "slam/pipeline/locate.hpp"

#include <algorithm>
#include <utility>

#include "slam/relocalize/relocalize.hpp"

namespace mh {
namespace {

/// Number of landmarks that a frame must match to be tracked: fewer if it shows few keypoints.
int inliers_needed(const Features& features, const TrackConfig& config) {
  const int share = static_cast<int>(features.size()) / 6;
  return std::min(config.min_inliers, std::max(config.min_inliers_sparse, share));
}

/// Localizes a frame from the last tracked one: by the motion model or the reference keyframe,
/// whichever is confirmed in the local map first. A frame that comes after lost frames needs as
/// many inliers as relocalization.
std::optional<Located> follow(const SlamState& state, const Tracker& tracker, PreparedFrame& frame,
                              const SlamContext& context, const StepObservers& observers) {
  if (!tracker.last) return std::nullopt;
  const auto by_motion = [&] {
    return track_motion(without_words(frame), *tracker.last, predict(tracker, frame.stamp_ns),
                        context);
  };
  const auto by_reference = [&] {
    return track_reference(with_words(frame, state, observers),
                           state.map.live_keyframe(tracker.reference),
                           tracker.last->camera_from_world, context);
  };
  const int min_inliers = tracker.coasting ? state.config.relocalize.min_inliers
                                           : inliers_needed(frame.features, state.config.track);
  // If the motion is not known yet, appearance needs no guess.
  const bool moving = tracker.velocity_per_s.has_value();
  for (const bool use_motion : {moving, !moving}) {
    std::optional<TrackedPose> tracked;
    {
      const InStage stage(observers, Stage::kTracking);
      tracked = use_motion ? by_motion() : by_reference();
    }
    if (!tracked) continue;
    if (auto located = confirm_in_local_map(frame, *tracked, min_inliers, context, observers))
      return located;
  }
  return std::nullopt;
}

std::optional<TrackedPose> search_everywhere(const SlamState& state, Tracker& tracker,
                                             PreparedFrame& frame, RandomStream stream,
                                             const StepObservers& observers, StepReport& report) {
  const InStage stage(observers, Stage::kRelocalization);
  RelocalizationResult found =
      relocalize(with_words(frame, state, observers), context_of(state, observers, report), stream,
                 nullptr, &tracker.stale_scores);
  report.relocalization = found.stage;
  report.candidates = found.candidates;
  if (!found.camera_from_world) return std::nullopt;
  return TrackedPose{*found.camera_from_world, std::move(found.landmarks), found.inliers};
}

}  // namespace

SlamContext context_of(const SlamState& state, const StepObservers& observers, StepReport& report) {
  return {state.camera,   state.config,      state.map,
          report.matches, observers.matches, observers.decisions};
}

std::optional<Located> confirm_in_local_map(const PreparedFrame& frame, const TrackedPose& tracked,
                                            int min_inliers, const SlamContext& context,
                                            const StepObservers& observers) {
  const InStage stage(observers, Stage::kLocalMap);
  const LocalMap local = local_map(tracked, context);
  auto refined = track_local_map(without_words(frame), tracked, local, context);
  if (!refined || refined->tracked.inliers < min_inliers) return std::nullopt;
  const KeyframeId reference = reference_of(refined->tracked, context.map);
  return Located{std::move(refined->tracked), reference, std::move(refined->expected)};
}

std::optional<Located> locate(const SlamState& state, Tracker& tracker, PreparedFrame& frame,
                              RandomStream stream, const StepObservers& observers,
                              StepReport& report) {
  const SlamConfig& config = state.config;
  const SlamContext context = context_of(state, observers, report);
  if (auto located = follow(state, tracker, frame, context, observers)) {
    fuse_with_prediction(*located, tracker, frame.stamp_ns, config.track);
    report.status = tracker.coasting ? TrackStatus::kRelocalized : TrackStatus::kTracked;
    return located;
  }
  const auto found = search_everywhere(state, tracker, frame, stream, observers, report);
  if (!found) return std::nullopt;
  auto located =
      confirm_in_local_map(frame, *found, config.relocalize.min_inliers, context, observers);
  if (located) {
    located->motion = Motion::at_rest(located->tracked.information.inverse());
    report.status = TrackStatus::kRelocalized;
  } else {
    report.relocalization = RelocalizationStage::kInliers;
  }
  return located;
}

}  // namespace mh
