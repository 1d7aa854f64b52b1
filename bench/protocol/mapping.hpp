// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "bench/protocol/system.hpp"
#include "bench/protocol/usable_frame.hpp"
#include "bench/suite/protocol_config.hpp"
#include "slam/core/digest.hpp"
#include "slam/core/sequence.hpp"

namespace mh {

/// One track call during mapping.
struct MappedFrame {
  std::size_t index = 0;  ///< in the sequence
  Stamp stamp_ns = 0;
  int restart = 0;  ///< restarts so far; part of the key of the random streams
  TrackStatus status = TrackStatus::kLost;
  std::optional<int> inliers;  ///< if the system reports them
  bool keyframe_added = false;
  bool map_reset = false;  ///< as in SystemReport
  std::uint64_t image_digest = 0;
  std::uint64_t matching_digest = 0;
  std::uint64_t pose_digest = 0;
};

template <MaybeConst<MappedFrame> F, class Visit>
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
  int failures = 0;                    ///< how often tracking was lost
  int restarts = 0;                    ///< rewinds
  int before_map = 0;                  ///< frames at the start, shown before there was a map
  bool gave_up = false;                ///< ProtocolConfig::max_effort was used up
  std::size_t offered = 0;             ///< frames of the sequence that are not test frames
  std::optional<MatchCounts> matches;  ///< summed over all track calls, if the system reports them
  std::vector<LoopClosure> loops;      ///< closed during the mapping, in order
  SkippedFrames skipped;               ///< only offered frames; the run counts skipped query frames
};

/// All fields except the calls.
template <MaybeConst<MappingOutcome> O, class Visit>
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

/// Whether frame `index` is a test frame, the last of every `test_interval` frames: 29, 59, ... for
/// an interval of 30; none for an interval of 0.
bool is_test_frame(std::size_t index, const ProtocolConfig& config);

/// Returns the indices, from `first` on, of the frames that are not test frames, in order.
std::vector<std::size_t> offered_frames(std::size_t count, const ProtocolConfig& config,
                                        std::size_t first = 0);

/// Receives the frame and report of each track call as it happens; used to report progress and to
/// retain keyframe depth.
using MappingObserver =
    std::function<void(const MappedFrame&, const RgbdFrame&, const SystemReport&)>;

/// Maps a sequence (section 3.1 of the paper; with OnFailure::kContinue, each frame is shown once
/// and the rules on rewinds below do not apply). A failure is a lost frame right after a tracked
/// one. After a failure at frame i, the feed rewinds to i - 50 and continues with the map as it is.
/// Frames lost on the way back to i are not failures, since the system is still relocalizing there;
/// if frame i itself is lost again, that is a failure. After five consecutive restarts that did not
/// get past i (the furthest frame that failed), the frame that failed last, which may be before i,
/// is dropped; the feed rewinds by 50 once more and the count starts over. Frames reported lost
/// before anything is mapped are skipped: there is nothing to rewind to.
///
/// Terminates: the frame to get past only moves forward, a drop removes a frame for good, and there
/// are at most five restarts between two of these events; after max_effort * count track calls (or
/// count + 1,000, if that is more), mapping ends and the remaining frames are not mapped.
///
/// A frame that cannot be shown to any system (SkippedFrames) is skipped, as if it did not exist.
///
/// The noise and the SLAM system draw from streams keyed by (restart, frame), so that a restart
/// does not replay the same draws.
/// @param first  frames before it are not offered: an earlier call already fed them to the system
/// @throws InputError if none of the first kHopeless frames, or no frame at all, can be shown.
MappingOutcome map_sequence(System& system, const Sequence& sequence, const ProtocolConfig& config,
                            RandomStream stream, const MappingObserver& observe = {},
                            std::size_t first = 0);

/// Result of localizing a sequence in a finished map.
struct Localization {
  MappingOutcome outcome;
  Trajectory trajectory;  ///< of the localized frames, in the map's world
};

/// Localizes a whole sequence in a frozen map with one session: once relocalized in a frame, the
/// camera is tracked to the next. Test frames and frames that cannot be shown are skipped.
/// @throws InputError as map_sequence() does
Localization localize_sequence(const System& frozen, const Sequence& sequence,
                               const ProtocolConfig& config, RandomStream stream,
                               const MappingObserver& observe = {});

}  // namespace mh
