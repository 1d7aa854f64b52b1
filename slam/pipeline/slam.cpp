// SPDX-License-Identifier: Apache-2.0
#include "slam/pipeline/slam.hpp"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "slam/features/undistort.hpp"
#include "slam/io/error.hpp"
#include "slam/vocabulary/word_index.hpp"

namespace mh {

void require_increasing_stamp(Stamp stamp_ns, std::optional<Stamp> last_ns) {
  if (last_ns && stamp_ns <= *last_ns)
    throw InputError(fmt::format("frame at {:.6f} s: stamps must increase, the last was {:.6f} s",
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
  state.config.semantics.label_mass = 0;  // applies to queries only; a map is made with gamma
  state.vocabulary = std::move(vocabulary);
  return state;
}

void rewind(SlamState& state) {
  Tracker& tracker = state.tracker;
  if (tracker.last &&
      tracker.last->odom_from_camera) {  // odometry predicts the poses of earlier frames, too
    tracker.velocity_per_s.reset();
    tracker.motion.reset();
    tracker.coasting = true;
  } else {
    forget(tracker);
  }
  state.last_stamp_ns.reset();
}

namespace {

/// The gamma at which labels hold the requested share of the keyframes' vectors.
double solved_gamma(const SlamState& state, SemanticConfig settings) {
  settings.gamma = 1;
  std::vector<double> shares;
  for (const Keyframe& keyframe : state.map.keyframes())
    if (!keyframe.erased)
      shares.push_back(
          index_words(keyframe.features, *state.vocabulary, settings).vector.label_mass());
  return gamma_for_label_mass(shares, settings.label_mass, setting::kMany);
}

}  // namespace

void set_query_settings(SlamState& state, const SemanticConfig& settings) {
  SemanticConfig& own = state.config.semantics;
  const bool by_mass = settings.label_mass > 0;
  const bool same_vectors = settings.void_is_a_label == own.void_is_a_label &&
                            settings.label_mass == own.label_mass &&
                            (by_mass || settings.gamma == own.gamma);
  SlamConfig config = state.config;
  config.semantics = settings;
  validate(config);
  const double gamma = !by_mass       ? settings.gamma
                       : same_vectors ? own.gamma
                                      : solved_gamma(state, settings);
  own = settings;
  own.gamma = gamma;
  if (same_vectors) return;
  for (const Keyframe& keyframe : state.map.keyframes())
    if (!keyframe.erased)
      state.map.set_words(keyframe.id, index_words(keyframe.features, *state.vocabulary, own));
}

MapPose map_pose(const SlamState& state, const TrackedFrame& frame) {
  return {state.map.at(frame.reference).origin,
          frame.camera_from_reference * state.map.camera_from_world(frame.reference)};
}

Trajectory trajectory(const SlamState& state) {
  Trajectory poses;
  for (const auto& [stamp_ns, frame] : state.tracked_frames) {
    const MapPose pose = map_pose(state, frame);
    poses.push_back({stamp_ns, pose.camera_from_world.inverse(), pose.origin.value});
  }
  return poses;
}

}  // namespace mh
