// SPDX-License-Identifier: Apache-2.0
#include "slam/pipeline/prepared_frame.hpp"

#include <utility>

#include "slam/track/rolling_shutter.hpp"

namespace mh {

Features observed_features(const RgbdFrame& frame, const SlamState& state,
                           const StepObservers& observers) {
  const InStage stage(observers, Stage::kFeatures);
  return extract(frame, state.camera, state.config.features);
}

PreparedFrame prepare(Stamp stamp_ns, Features features, const SlamState& state,
                      const Tracker& tracker) {
  const Camera& camera = state.camera;
  if (tracker.tracking() && tracker.velocity_per_s)
    straighten(features.keypoints, camera, *tracker.velocity_per_s, state.config.track.readout_s);
  FeatureGrid grid(features.keypoints, camera);
  return {stamp_ns, std::move(features), std::move(grid), std::nullopt};
}

Query with_words(PreparedFrame& frame, const SlamState& state, const StepObservers& observers) {
  if (!frame.words) {
    const InStage stage(observers, Stage::kWords);
    frame.words = index_words(frame.features, *state.vocabulary, state.config.semantics);
  }
  return {frame.features, frame.grid, *frame.words};
}

Query without_words(const PreparedFrame& frame) {
  static const WordIndex kNone;
  return {frame.features, frame.grid, frame.words ? *frame.words : kNone};
}

}  // namespace mh
