// SPDX-License-Identifier: Apache-2.0
#include "slam/pipeline/add_keyframe.hpp"

#include <iterator>
#include <utility>

#include "slam/loop/loop.hpp"
#include "slam/mapping/local_mapping.hpp"
#include "slam/pipeline/locate.hpp"

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

/// Whether the camera can have come from one piece of the map to the other, in either direction,
/// wherever it did so.
bool is_reachable(const SlamState& state, KeyframeId origin, const MapPose& world) {
  const auto& frames = state.tracked_frames;
  const auto piece_of = [&](const auto& frame) {
    return state.map.at(frame->second.reference).origin;
  };
  for (auto before = frames.begin(); before != frames.end(); ++before) {
    const auto after = std::next(before);
    if (after == frames.end()) break;
    const bool leaves = piece_of(before) == origin && piece_of(after) == world.origin;
    const bool enters = piece_of(before) == world.origin && piece_of(after) == origin;
    if (!leaves && !enters) continue;
    SE3 a = map_pose(state, before->second).camera_from_world,
        b = map_pose(state, after->second).camera_from_world;
    (leaves ? a : b) = (leaves ? a : b) * world.camera_from_world;
    if (!within_reach(a, b, after->first - before->first, state.config.track.max_speed_m_s))
      return false;
  }
  return true;
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
