// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>

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

/// The complete state of one SLAM run. It has value semantics: copying it copies the map.
struct SlamState {
  Camera camera;         // including what was learned about its depth
  int depth_frames = 0;  ///< number of frames from which this was learned
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

/// Processes one frame, including mapping; step.cpp shows the whole pipeline on one page. The first
/// frame with enough depth defines the world origin. Random draws depend only on the stream.
/// @throws InputError if the frame does not fit the camera or its stamp does not increase.
StepReport step(SlamState& state, const RgbdFrame& frame, RandomStream stream,
                const StepObservers& observers = {});

/// The same, starting from features that exist already, from a cache or a synthetic world. The
/// overload for a frame calls extract() and then this one.
/// @param odom_from_camera, imu  as in RgbdFrame
/// @throws InputError if the stamp does not increase or the numbers of descriptors and keypoints
/// differ.
StepReport step(SlamState& state, Stamp stamp_ns, Features features, RandomStream stream,
                const StepObservers& observers = {},
                const std::optional<SE3>& odom_from_camera = {},
                std::span<const ImuReading> imu = {});

/// @throws InputError naming both stamps if the frame's is not later than the last one's.
void require_increasing_stamp(Stamp stamp_ns, std::optional<Stamp> last_ns);

/// Prepares for input that jumps back in time: tracking is lost, earlier stamps are accepted, and
/// the map is kept. Odometry, if available, still gives the camera's pose.
void rewind(SlamState& state);

/// Localizes a frame in a frozen map. The caller owns the tracker, so that many queries can start
/// from the same state; a new Tracker{} starts lost. Stamps are not checked.
StepReport localize(const SlamState& frozen, Tracker& tracker, const RgbdFrame& frame,
                    RandomStream stream, const StepObservers& observers = {});

/// Results that localizations of one frame, each from a lost tracker, can share if the stream and
/// trial_key() are the same: features, words, attempts at candidates, refined poses. Changing the
/// settings that select candidates (gamma, alpha, beta, overlap) then repeats only the selection.
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

/// localize() from a lost tracker that is discarded afterward, reusing earlier results.
/// @param memo  of the same frame, stream, map and trial_key()
StepReport localize(const SlamState& frozen, const RgbdFrame& frame, RandomStream stream,
                    LocalizeMemo& memo);

/// Changes the semantic settings that are used from now on to answer queries and extend the map. If
/// gamma or the void policy changes, the keyframes' vectors (equation 1) are reweighted. If
/// `label_mass` is set, gamma becomes the one at which labels hold this share of the current
/// keyframes' vectors on average.
/// @throws InputError naming the setting that is out of range; the state is then unchanged.
void set_query_settings(SlamState& state, const SemanticConfig& settings);

/// The pose of a tracked frame in the current map.
MapPose map_pose(const SlamState& state, const TrackedFrame& frame);

/// One pose per tracked frame (from its last attempt), ordered by stamp: the pose relative to its
/// reference keyframe, composed with that keyframe's current pose, in the world of its piece of the
/// map. The world of the first piece has its origin at the first camera pose.
Trajectory trajectory(const SlamState& state);

}  // namespace mh
