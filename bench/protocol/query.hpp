// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bench/protocol/mapping.hpp"
#include "bench/protocol/system.hpp"
#include "bench/suite/protocol_config.hpp"

namespace mh {

/// A system's answer to one test frame.
struct QueryAnswer {
  std::size_t index = 0;                 ///< of the test frame in its sequence
  int blank_frames = 0;                  ///< number shown until the system was lost
  int attempts = 0;                      ///< how often the test frame was shown
  std::optional<SE3> world_from_camera;  ///< the first returned pose
  std::uint32_t map = 0;                 ///< SystemReport::map
  /// The furthest stage that an attempt reached, if the system reports it; kVerified if a pose was
  /// returned.
  std::optional<RelocalizationStage> stage;
  Candidates candidates;               ///< of the first attempt
  std::optional<MatchCounts> matches;  ///< summed over attempts
  std::uint64_t image_digest = 0;      ///< chained over attempts
  std::uint64_t matching_digest = 0;
  std::uint64_t pose_digest = 0;
};

template <MaybeConst<QueryAnswer> A, class Visit>
void fields(A& answer, Visit& v) {
  auto& [index, blank_frames, attempts, world_from_camera, map, stage, candidates, matches,
         image_digest, matching_digest, pose_digest] = answer;
  v("frame", index);
  v("blank_frames", blank_frames);
  v("attempts", attempts);
  v("estimate", world_from_camera);
  v("map", map);
  v("stage", stage);
  v("candidates", candidates);
  v("matchers", matches);
  v("image", as_digest(image_digest));
  v("matching", as_digest(matching_digest));
  v("pose", as_digest(pose_digest));
}

/// A black image without depth or labels, which the paper shows between test frames.
RgbdFrame blank_frame(int width_px, int height_px, Stamp stamp_ns);

/// Whether a frame shows nothing at all, like one from blank_frame().
bool is_blank(const RgbdFrame& frame);

/// The random streams of one presentation of a test frame.
struct Presentation {
  RandomStream noise, draws;  ///< noise of the frame, draws of the system
};
/// @param stream   of the set of queries
/// @param index    of the test frame
/// @param attempt  from 0
Presentation presentation(RandomStream stream, std::size_t index, int attempt, Attempts attempts);

/// Queries a frozen system with one test frame (section 3.2 of the paper). In a fresh session,
/// shows blank frames until the system is lost, then the test frame until a pose is returned, at
/// most config.query_attempts times; config.attempts determines each attempt's noise. The noise and
/// the SLAM system draw from streams keyed only by (test frame, attempt), so the answer depends on
/// no other query (except with `neighbor_scores: as_released`).
/// @throws UnusableFrame if the frame cannot be shown.
/// @param memo  from frozen.make_memo(), for this query alone, or null; does not change the answer
QueryAnswer query(const System& frozen, std::size_t index, const Sequence& sequence,
                  const ProtocolConfig& config, RandomStream stream, QueryMemo* memo = nullptr);

/// Returns the test frames of a sequence, in order.
std::vector<std::size_t> test_frames(std::size_t count, const ProtocolConfig& config);

}  // namespace mh
