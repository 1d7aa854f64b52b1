// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "slam/core/camera.hpp"
#include "slam/core/random.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/trajectory.hpp"
#include "slam/map/map.hpp"
#include "slam/pipeline/config.hpp"
#include "slam/track/tracker.hpp"
#include "slam/vocabulary/vocabulary.hpp"

namespace mh {

/// The whole state of one SLAM run: a value. Copying it copies the map.
struct SlamState {
  Camera camera;
  SlamConfig config;
  std::shared_ptr<const Vocabulary> vocabulary;  // shared: large, immutable
  Map map;
  Tracker tracker;
};

/// @throws InputError / std::invalid_argument if camera or config are out of range.
SlamState make_slam(const Camera& camera, const SlamConfig& config,
                    std::shared_ptr<const Vocabulary> vocabulary);

/// Processes one frame, mapping included. Random draws depend on the stream alone.
/// @throws InputError if the frame does not fit the camera or its stamp does not grow.
StepReport step(SlamState& state, const RgbdFrame& frame, RandomStream stream);

/// The feed goes back: tracking counts as lost and earlier stamps are accepted; the map stays.
void rewind(SlamState& state);

/// Localization against a map that no longer changes. The tracker is the caller's, so that many
/// queries start from equal states: Tracker{} is lost.
StepReport localize(const SlamState& frozen, Tracker& tracker, const RgbdFrame& frame,
                    RandomStream stream);

/// Each tracked frame once (its last attempt), ordered by stamp, as its pose relative to its
/// reference keyframe composed with that keyframe's pose now.
Trajectory trajectory(const SlamState& state);

}  // namespace mh
