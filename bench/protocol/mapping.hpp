// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "bench/protocol/config.hpp"
#include "bench/protocol/system.hpp"
#include "bench/protocol/usable_frame.hpp"
#include "bench/provenance/digest.hpp"
#include "slam/core/sequence.hpp"

namespace mh {

/// One track call of the mapping, in order.
struct MappedFrame {
  std::size_t index = 0;  ///< in the sequence
  Stamp stamp_ns = 0;
  int restart = 0;  ///< restarts so far: it keys the random streams
  TrackStatus status = TrackStatus::kLost;
  std::optional<int> inliers;  ///< where the system tells
  bool keyframe_added = false;
  bool map_reset = false;  ///< as SystemReport
  std::uint64_t image_digest = 0;
  std::uint64_t matching_digest = 0;
  std::uint64_t pose_digest = 0;
};

template <Either<MappedFrame> F, class Visit>
void fields(F& call, Visit& v) {
  auto& [index, stamp_ns, restart, status, inliers, keyframe_added, map_reset, image_digest,
         matching_digest, pose_digest] = call;
  v("frame", index);
  v("stamp_ns", stamp_ns);
  v("restart", restart);
  v("status", status);
  v("inliers", inliers);
  v("keyframe", keyframe_added);
  v("map_reset", map_reset);
  v("image", as_digest(image_digest));
  v("matching", as_digest(matching_digest));
  v("pose", as_digest(pose_digest));
}

struct MappingOutcome {
  std::vector<MappedFrame> calls;
  std::vector<std::size_t> dropped;    ///< frames removed after too many failed restarts, in order
  int failures = 0;                    ///< times that tracking was lost
  int restarts = 0;                    ///< rewinds
  int before_map = 0;                  ///< frames at the start that gave no map yet
  bool gave_up = false;                ///< ProtocolConfig::max_effort was spent
  std::size_t offered = 0;             ///< frames of the sequence that are no test frames
  std::optional<MatchCounts> matches;  ///< summed over all track calls, where the system tells
  std::vector<LoopClosure> loops;      ///< closed on the way, in order
  SkippedFrames skipped;               ///< of those offered; queries' are counted by the run
};

/// But for the calls.
template <Either<MappingOutcome> O, class Visit>
void fields(O& outcome, Visit& v) {
  auto& [calls, dropped, failures, restarts, before_map, gave_up, offered, matches, loops,
         skipped] = outcome;
  v("dropped", dropped);
  v("failures", failures);
  v("restarts", restarts);
  v("before_map", before_map);
  v("gave_up", gave_up);
  v("offered", offered);
  v("matches", matches);
  v("loops", loops);
  v("skipped", skipped);
}

/// Test frames are the last of every `test_interval`: 29, 59, ... at 30; none at 0.
bool is_test_frame(std::size_t index, const ProtocolConfig& config);

/// The frames of a sequence from `first` on that are no test frames, in order.
std::vector<std::size_t> offered_frames(std::size_t count, const ProtocolConfig& config,
                                        std::size_t first = 0);

/// Frame and report of a track call as it happens: for progress and for keeping keyframe depth.
using MappingObserver =
    std::function<void(const MappedFrame&, const RgbdFrame&, const SystemReport&)>;

/// Maps a sequence (section 3.1 of the paper; at OnFailure::kContinue each frame is shown once, and
/// what follows on rewinds does not apply). A failure is a frame reported lost while tracking
/// was on, or a frame reported lost at which the feed had failed before. After a failure at frame i
/// the feed goes back to i - 50 and goes on with the map as it is; frames reported lost on the way
/// back to i are no failures: the system is still relocalizing there. After five restarts in a row
/// that did not get past the trouble, the frame that failed last is dropped, the feed goes back 50
/// once more and the count starts again. Frames reported lost before anything is mapped are passed
/// over: there is nothing to go back to.
///
/// Ends: the frame to get past only moves forward, a drop removes a frame for good, and between two
/// of these events there are at most five restarts; beyond max_effort * count track calls (or
/// count + 1,000, if more) the rest stays unmapped.
///
/// A frame that no system can be shown (SkippedFrames) is skipped, as if it were not there.
///
/// Noise and SLAM draw from streams keyed by (restart, frame), so that a restart is no replica.
/// @param first  frames before it are not offered: the system was fed them by an earlier call
/// @throws InputError if none of the first kHopeless frames can be shown, or none at all.
MappingOutcome map_sequence(System& system, const Sequence& sequence, const ProtocolConfig& config,
                            RandomStream stream, const MappingObserver& observe = {},
                            std::size_t first = 0);

/// What came of a sequence that was looked for in a finished map.
struct Localization {
  MappingOutcome outcome;
  Trajectory trajectory;  ///< the frames that were found, in the map's world
};

/// Shows a whole sequence to one session before a frozen map: found in one frame, the camera is
/// tracked to the next. Test frames and frames that cannot be shown are passed over.
/// @throws InputError as map_sequence()
Localization localize_sequence(const System& frozen, const Sequence& sequence,
                               const ProtocolConfig& config, RandomStream stream,
                               const MappingObserver& observe = {});

/// The noise stream of mapping frames after so many restarts; equal for every system.
RandomStream mapping_noise(RandomStream stream, int restart);

}  // namespace mh
