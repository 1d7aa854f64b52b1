// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <utility>

#include "slam/pipeline/locate.hpp"
#include "slam/pipeline/slam.hpp"
#include "slam/relocalize/relocalize.hpp"

namespace mh {

StepReport localize(const SlamState& frozen, Tracker& tracker, const RgbdFrame& frame,
                    RandomStream stream, const StepObservers& observers) {
  PreparedFrame prepared =
      prepare(frame.stamp_ns, observed_features(frame, frozen, observers), frozen, tracker);
  StepReport report;
  report.keypoints = static_cast<int>(prepared.features.size());
  auto located = locate(frozen, tracker, prepared, stream, observers, report);
  if (!located) {
    lose(tracker, frame.stamp_ns, frozen.config.track.coast_s);
    return report;
  }
  report.inliers = located->tracked.inliers;
  update_velocity(tracker, frame.stamp_ns, located->tracked.camera_from_world);
  report.world_from_camera = located->tracked.camera_from_world.inverse();
  report.origin = frozen.map.at(located->reference).origin;
  remember(tracker,
           {prepared.stamp_ns, located->tracked.camera_from_world, std::move(prepared.features),
            std::move(located->tracked.landmarks)},
           located->reference, located->motion);
  return report;
}

struct LocalizeMemo::Content {
  /// Result of refining the winning candidate's pose in the local map, with the match counts of
  /// this refinement.
  struct Refined {
    std::optional<SE3> camera_from_world;
    int inliers = 0;
    MatchCounts counts{};
  };
  std::optional<PreparedFrame> frame;
  double gamma = 0;  ///< of the frame's words
  AttemptMemo attempts;
  std::map<KeyframeId, Refined> refined;
};
LocalizeMemo::LocalizeMemo() : content_(std::make_unique<Content>()) {}
LocalizeMemo::~LocalizeMemo() = default;
LocalizeMemo::LocalizeMemo(LocalizeMemo&&) noexcept = default;

StepReport localize(const SlamState& frozen, const RgbdFrame& frame, RandomStream stream,
                    LocalizeMemo& memo) {
  LocalizeMemo::Content& known = *memo.content_;
  const SlamConfig& config = frozen.config;
  if (!known.frame)
    known.frame =
        prepare(frame.stamp_ns, extract(frame, frozen.camera, config.features), frozen, Tracker{});
  if (known.gamma != config.semantics.gamma) known.frame->words.reset();
  known.gamma = config.semantics.gamma;

  const StepObservers observers;
  StepReport report;
  report.keypoints = static_cast<int>(known.frame->features.size());
  const RelocalizationResult found =
      relocalize(with_words(*known.frame, frozen, observers), context_of(frozen, observers, report),
                 stream, &known.attempts);
  report.relocalization = found.stage;
  report.candidates = found.candidates;
  if (!found.camera_from_world) return report;

  const auto [place, is_new] = known.refined.try_emplace(found.keyframe);
  LocalizeMemo::Content::Refined& refined = place->second;
  if (is_new) {
    StepReport of_refining;
    if (const auto located = confirm_in_local_map(
            *known.frame, {*found.camera_from_world, found.landmarks, found.inliers},
            frozen.map.at(found.keyframe).origin, config.relocalize.min_inliers,
            context_of(frozen, observers, of_refining), observers)) {
      refined.camera_from_world = located->tracked.camera_from_world;
      refined.inliers = located->tracked.inliers;
    }
    refined.counts = of_refining.matches;
  }
  add(refined.counts, report.matches);
  if (!refined.camera_from_world) {
    report.relocalization = RelocalizationStage::kInliers;
    return report;
  }
  report.status = TrackStatus::kRelocalized;
  report.inliers = refined.inliers;
  report.world_from_camera = refined.camera_from_world->inverse();
  report.origin = frozen.map.at(found.keyframe).origin;
  return report;
}

}  // namespace mh
