// SPDX-License-Identifier: Apache-2.0
#include "slam/pipeline/locate.hpp"

#include <algorithm>
#include <utility>

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
/// @param reckoned  if present, predicts the motion in place of the last step
std::optional<Located> follow(const SlamState& state, const Tracker& tracker,
                              const std::optional<Reckoned>& reckoned, PreparedFrame& frame,
                              const SlamContext& context, const StepObservers& observers,
                              const IsPossible& is_possible) {
  if (!tracker.last) return std::nullopt;
  const auto by_motion = [&] {
    return track_motion(without_words(frame), *tracker.last,
                        reckoned ? reckoned->camera_from_world : predict(tracker, frame.stamp_ns),
                        context);
  };
  const auto by_reference = [&] {
    return track_reference(with_words(frame, state, observers),
                           state.map.live_keyframe(tracker.reference),
                           tracker.last->camera_from_world, context);
  };
  const int min_inliers = tracker.coasting ? state.config.relocalize.min_inliers
                                           : inliers_needed(frame.features, state.config.track);
  // If the motion is not known yet, appearance comes first, since it needs no guess.
  const bool moving = tracker.velocity_per_s.has_value() || reckoned;
  const KeyframeId origin = state.map.at(tracker.reference).origin;
  for (const bool use_motion : {moving, !moving}) {
    std::optional<TrackedPose> tracked;
    {
      const InStage stage(observers, Stage::kTracking);
      tracked = use_motion ? by_motion() : by_reference();
    }
    if (!tracked) continue;
    if (auto located =
            confirm_in_local_map(frame, *tracked, origin, min_inliers, context, observers))
      if (!is_possible || is_possible({origin, located->tracked.camera_from_world})) return located;
  }
  return std::nullopt;
}

/// Localizes a frame in the map around a pose.
std::optional<Located> find_near(const MapPose& guess, double radius_px, const PreparedFrame& frame,
                                 const SlamContext& context, const StepObservers& observers) {
  std::optional<TrackedPose> near;
  {
    const InStage stage(observers, Stage::kTracking);
    near = track_near(without_words(frame), guess, radius_px, context);
  }
  if (!near) return std::nullopt;
  return confirm_in_local_map(frame, *near, guess.origin,
                              inliers_needed(frame.features, context.config.track), context,
                              observers);
}

/// Localizes a frame where another sensor places it: in the map around that pose or, if the image
/// cannot contradict it, by that sensor alone.
std::optional<Located> follow_reckoned(const SlamState& state, const Tracker& tracker,
                                       const Reckoned& reckoned, PreparedFrame& frame,
                                       const SlamContext& context, const StepObservers& observers) {
  const TrackConfig& config = state.config.track;
  const PoseSigma sigma = worst_sigma(reckoned.covariance);
  const double radius_px = config.search_radius_px + 2 * sigma.angle_rad * context.camera.fx_px;
  const MapPose guess{state.map.at(tracker.reference).origin, reckoned.camera_from_world};
  if (auto located = find_near(guess, radius_px, frame, context, observers))
    if (reckoned.allows(located->tracked, config)) return located;
  // The image does not confirm the pose. If the pose is well known, the last frame's points should
  // be in view, and the frame shows many features, then the wheels slipped or the robot was carried
  // away.
  constexpr double kKnown_m = 0.05, kKnown_rad = 0.03;
  if (sigma.position_m <= kKnown_m && sigma.angle_rad <= kKnown_rad &&
      static_cast<int>(frame.features.size()) >= 3 * config.min_inliers &&
      count_that_can_be_found(*tracker.last, reckoned.camera_from_world, context.map,
                              context.camera) >= 3 * config.min_inliers)
    return std::nullopt;
  Located located;
  located.tracked.camera_from_world = reckoned.camera_from_world;
  located.tracked.landmarks.resize(frame.features.size());
  located.reference = state.map.live_keyframe(tracker.reference);
  located.motion = Motion::at_rest(reckoned.covariance);
  located.reckoning = reckoned.reckoning;
  return located;
}

/// Localizes a frame by its words, wherever it is.
std::optional<Located> search_everywhere(const SlamState& state, Tracker& tracker,
                                         PreparedFrame& frame, RandomStream stream,
                                         const StepObservers& observers, StepReport& report,
                                         const IsPossible& is_possible) {
  const SlamContext context = context_of(state, observers, report);
  RelocalizationResult found;
  {
    const InStage stage(observers, Stage::kRelocalization);
    found = relocalize(with_words(frame, state, observers), context, stream, nullptr,
                       &tracker.stale_scores, is_possible);
  }
  report.relocalization = found.stage;
  report.candidates = found.candidates;
  if (!found.camera_from_world) return std::nullopt;
  return confirm_in_local_map(
      frame, {*found.camera_from_world, std::move(found.landmarks), found.inliers},
      state.map.at(found.keyframe).origin, state.config.relocalize.min_inliers, context, observers);
}

}  // namespace

SlamContext context_of(const SlamState& state, const StepObservers& observers, StepReport& report) {
  return {state.camera,   state.config,      state.map,
          report.matches, observers.matches, observers.decisions};
}

std::optional<Located> confirm_in_local_map(const PreparedFrame& frame, const TrackedPose& tracked,
                                            KeyframeId origin, int min_inliers,
                                            const SlamContext& context,
                                            const StepObservers& observers) {
  const InStage stage(observers, Stage::kLocalMap);
  const LocalMap local = local_map(tracked, origin, context);
  auto refined = track_local_map(without_words(frame), tracked, local, context);
  if (!refined || refined->tracked.inliers < min_inliers) return std::nullopt;
  const KeyframeId reference = reference_of(refined->tracked, context.map);
  return Located{std::move(refined->tracked), reference, std::move(refined->expected)};
}

std::optional<Located> locate(const SlamState& state, Tracker& tracker, PreparedFrame& frame,
                              RandomStream stream, const StepObservers& observers,
                              StepReport& report, const KnownBefore& known) {
  const SlamConfig& config = state.config;
  const SlamContext context = context_of(state, observers, report);
  const auto reckoned =
      reckon(tracker, frame.stamp_ns, frame.odom_from_camera, frame.imu, config.track);
  auto located = follow(state, tracker, reckoned, frame, context, observers, known.is_possible);
  if (located && reckoned && !reckoned->allows(located->tracked, config.track)) located.reset();
  if (!located && reckoned)
    located = follow_reckoned(state, tracker, *reckoned, frame, context, observers);
  if (located && located->reckoning.is_zero())
    fuse_with_prediction(*located, tracker, frame.stamp_ns, reckoned, config.track);
  if (located) {
    follow_inertially(*located, reckoned, frame.imu, tracker);
    report.status = tracker.coasting ? TrackStatus::kRelocalized : TrackStatus::kTracked;
    return located;
  }
  if (known.earlier_pose)
    located =
        find_near(*known.earlier_pose, config.track.search_radius_px, frame, context, observers);
  if (!located) {
    located =
        search_everywhere(state, tracker, frame, stream, observers, report, known.is_possible);
    // As long as another sensor gives the camera's place, a match far from there is a different
    // place that looks the same.
    if (located && reckoned && !reckoned->allows(located->tracked, config.track)) located.reset();
    if (!located) {
      report.relocalization = std::min(report.relocalization, RelocalizationStage::kInliers);
      return std::nullopt;
    }
  }
  located->motion = Motion::at_rest(located->tracked.information.inverse());
  follow_inertially(*located, {}, frame.imu, tracker);
  report.status = TrackStatus::kRelocalized;
  return located;
}

}  // namespace mh
