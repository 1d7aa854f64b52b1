// SPDX-License-Identifier: Apache-2.0
#include "slam/pipeline/add_keyframe.hpp"

#include <utility>

#include "slam/loop/loop.hpp"
#include "slam/mapping/local_mapping.hpp"
#include "slam/pipeline/locate.hpp"
#include "slam/pipeline/pieces.hpp"

namespace mh {
namespace {

/// @param landmarks  per feature; invalid = none
KeyframeId map_frame(Map& map, Keyframe keyframe, const std::vector<LandmarkId>& landmarks,
                     const SlamContext& context) {
  const KeyframeId id = map.add(std::move(keyframe));
  for (std::uint32_t i = 0; i < landmarks.size(); ++i)
    if (landmarks[i].valid()) {
      map.add_observation(landmarks[i], id, i);
      map.refresh(landmarks[i], context.config.features);
    }
  add_landmarks_from_depth(map, id, context);
  if (map.at(id).origin != id) map_keyframe(map, id, context);
  return id;
}

void look_for_loop(SlamState& state, KeyframeId newest, RandomStream stream,
                   const SlamContext& context, StepReport& report) {
  auto loop = detect_loop(newest, state.loop_memory, context, stream);
  const KeyframeId origin = state.map.at(newest).origin;
  if (!loop)
    loop =
        recognize_piece(newest, state.loop_memory, context, stream.fork(1),
                        [&](const MapPose& world) { return is_reachable(state, origin, world); });
  if (!loop) return;
  const Keyframe& old = state.map.at(loop->old_keyframe);
  report.loop = LoopClosure{state.map.at(newest).stamp_ns, old.stamp_ns,
                            old.camera_from_world * loop->camera_from_world.inverse()};
  close_loop(state.map, *loop, context);
  report.loop_closed = true;
}

}  // namespace

KeyframeId add_keyframe(SlamState& state, PreparedFrame& frame, const TrackedPose& tracked,
                        KeyframeId origin, RandomStream stream, const StepObservers& observers,
                        StepReport& report) {
  const SlamContext context = context_of(state, observers, report);
  Keyframe keyframe;
  keyframe.origin = origin;
  keyframe.stamp_ns = frame.stamp_ns;
  keyframe.camera_from_world = tracked.camera_from_world;
  keyframe.words = with_words(frame, state, observers).words;
  keyframe.features = frame.features;
  keyframe.grid = frame.grid;
  keyframe.odom_from_camera = frame.odom_from_camera;
  KeyframeId id;
  {
    const InStage stage(observers, Stage::kMapping);
    id = map_frame(state.map, std::move(keyframe), tracked.landmarks, context);
  }
  if (state.config.loop.enabled) {
    const InStage stage(observers, Stage::kLoop);
    look_for_loop(state, id, stream, context, report);
  }
  report.keyframe_added = true;
  state.tracker.frames_since_keyframe = 0;
#ifndef NDEBUG
  state.map.check_invariants();
#endif
  return id;
}

}  // namespace mh
