// SPDX-License-Identifier: Apache-2.0
#include "slam/pipeline/slam.hpp"

#include <utility>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/features/undistort.hpp"
#include "slam/vocabulary/word_index.hpp"

namespace mh {

void require_increasing_stamp(Stamp stamp_ns, std::optional<Stamp> last_ns) {
  if (last_ns && stamp_ns <= *last_ns)
    throw InputError(fmt::format("frame at {:.6f} s: stamps must grow, the last was {:.6f} s",
                                 static_cast<double>(stamp_ns) * 1e-9,
                                 static_cast<double>(*last_ns) * 1e-9));
}

SlamState make_slam(const Camera& camera, const SlamConfig& config,
                    std::shared_ptr<const Vocabulary> vocabulary) {
  validate(camera);
  require_undistortable(camera);
  validate(config);
  SlamState state;
  state.camera = camera;
  state.config = config;
  state.vocabulary = std::move(vocabulary);
  return state;
}

void rewind(SlamState& state) {
  forget(state.tracker);
  state.last_stamp_ns.reset();
}

void set_query_settings(SlamState& state, const SemanticConfig& settings) {
  SemanticConfig& own = state.config.semantics;
  const bool same_vectors =
      settings.gamma == own.gamma && settings.void_is_a_label == own.void_is_a_label;
  SlamConfig config = state.config;
  config.semantics = settings;
  validate(config);
  own = settings;
  if (same_vectors) return;
  for (const Keyframe& keyframe : state.map.keyframes())
    if (!keyframe.erased)
      state.map.set_words(keyframe.id, index_words(keyframe.features, *state.vocabulary, settings));
}

Trajectory trajectory(const SlamState& state) {
  Trajectory poses;
  for (const auto& [stamp_ns, frame] : state.tracked_frames)
    poses.push_back(
        {stamp_ns,
         (frame.camera_from_reference * state.map.camera_from_world(frame.reference)).inverse()});
  return poses;
}

}  // namespace mh
