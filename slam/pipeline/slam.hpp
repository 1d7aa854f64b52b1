// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "slam/config/slam.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/random.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/trajectory.hpp"
#include "slam/loop/loop.hpp"
#include "slam/map/map.hpp"
#include "slam/pipeline/observe.hpp"
#include "slam/pipeline/report.hpp"
#include "slam/track/tracker.hpp"
#include "slam/vocabulary/vocabulary.hpp"

namespace mh {

/// A tracked frame, stored relative to its reference keyframe so that it moves with the map.
struct TrackedFrame {
  KeyframeId reference;
  SE3 camera_from_reference;
};

/// The complete state of one SLAM run: a value. Copying it copies the map.
struct SlamState {
  Camera camera;
  SlamConfig config;
  std::shared_ptr<const Vocabulary> vocabulary;  // shared: large, immutable
  Map map;
  Tracker tracker;
  LoopMemory loop_memory;
  std::map<Stamp, TrackedFrame> tracked_frames;  ///< the last attempt at each stamp, if it
                                                 ///< succeeded
  std::optional<Stamp> last_stamp_ns;            ///< of the last frame processed
};

/// @throws InputError naming the field of camera or config that is out of range, or a distortion
/// that cannot be inverted.
SlamState make_slam(const Camera& camera, const SlamConfig& config,
                    std::shared_ptr<const Vocabulary> vocabulary);

/// Processes one frame, mapping included: the whole system on one page (step.cpp). The first frame
/// with enough depth defines the world origin. Random draws depend only on the stream.
/// @throws InputError if the frame does not fit the camera or its stamp does not increase.
StepReport step(SlamState& state, const RgbdFrame& frame, RandomStream stream,
                const StepObservers& observers = {});

/// The same from existing features: from a cache or a synthetic world. step(state, frame, stream)
/// is extract() followed by this.
/// @throws InputError if the stamp does not increase or the numbers of descriptors and keypoints
/// differ.
StepReport step(SlamState& state, Stamp stamp_ns, Features features, RandomStream stream,
                const StepObservers& observers = {});

/// @throws InputError naming both if a frame's stamp is not later than the last one's.
void require_increasing_stamp(Stamp stamp_ns, std::optional<Stamp> last_ns);

/// Restarts the input: tracking is lost and earlier stamps are accepted; the map stays.
void rewind(SlamState& state);

/// Localizes a frame in a frozen map. The caller owns the tracker, so that many queries can start
/// from equal states: Tracker{} is lost. Stamps are not checked.
StepReport localize(const SlamState& frozen, Tracker& tracker, const RgbdFrame& frame,
                    RandomStream stream, const StepObservers& observers = {});

/// What localizations of one frame under one stream, each from a lost tracker, can share while xi
/// and the void policy stay the same: features, words, attempts at candidates, refined poses.
/// Settings that choose other candidates (gamma, alpha, beta, overlap) then cost only that choice.
class LocalizeMemo {
 public:
  LocalizeMemo();
  ~LocalizeMemo();
  LocalizeMemo(LocalizeMemo&&) noexcept;

 private:
  friend StepReport localize(const SlamState&, const RgbdFrame&, RandomStream, LocalizeMemo&);
  struct Content;
  std::unique_ptr<Content> content_;
};

/// localize() from a lost tracker that is discarded afterwards, reusing earlier results.
/// @param memo  of the same frame, stream and map, and of the same xi and void policy
StepReport localize(const SlamState& frozen, const RgbdFrame& frame, RandomStream stream,
                    LocalizeMemo& memo);

/// Changes the semantic settings by which the map answers queries and is extended from now on: its
/// keyframes' vectors (equation 1) are reweighted if gamma or the void policy changes.
/// @throws InputError naming the setting that is out of range; then nothing has changed.
void set_query_settings(SlamState& state, const SemanticConfig& settings);

/// Each tracked frame once (its last attempt), ordered by stamp: its pose relative to its reference
/// keyframe, composed with that keyframe's current pose. The reference frame is the first camera.
Trajectory trajectory(const SlamState& state);

}  // namespace mh
