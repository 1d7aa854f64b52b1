// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "slam/io/setting.hpp"

namespace mh {

/// What is reset after a frame was dropped (section 3.1 of the paper leaves this open).
enum class DropReset {
  kCounter,  ///< the count of failed restarts is cleared, the map is kept
  kMap,      ///< the system discards its map, too
};

constexpr std::array<std::pair<std::string_view, DropReset>, 2> words(DropReset) {
  return {{{"counter", DropReset::kCounter}, {"map", DropReset::kMap}}};
}

/// What the feed does when tracking is lost.
enum class OnFailure {
  kRewind,    ///< rewinds (section 3.1 of the paper)
  kContinue,  ///< continues with the next frame, as a camera does
};

constexpr std::array<std::pair<std::string_view, OnFailure>, 2> words(OnFailure) {
  return {{{"rewind", OnFailure::kRewind}, {"continue", OnFailure::kContinue}}};
}

/// What a query's answer is compared with.
enum class QueryTruth {
  kLocal,  ///< the nearest mapped frame's estimate, propagated to the query by the true motion
  /// The estimate interpolated in time between the mapped frames before and after the query
  /// (section 3.2 of the paper: "based on the camera poses with neighboring frames"). Needs no
  /// ground truth, but inherits the errors of the estimates. Without two near neighbors, kLocal
  /// applies.
  kInterpolated,
};

constexpr std::array<std::pair<std::string_view, QueryTruth>, 2> words(QueryTruth) {
  return {{{"local", QueryTruth::kLocal}, {"interpolated", QueryTruth::kInterpolated}}};
}

/// How the attempts of one query differ. RANSAC's draws differ in any case.
enum class Attempts {
  kSameFrame,  ///< the same frame again, with its noise
  kNewNoise,   ///< the same view with independent noise in every attempt
};

constexpr std::array<std::pair<std::string_view, Attempts>, 2> words(Attempts) {
  return {{{"same_frame", Attempts::kSameFrame}, {"new_noise", Attempts::kNewNoise}}};
}

/// The settings of the paper's sections 3.1 and 3.2.
struct ProtocolConfig {
  int test_interval = 30;  ///< 0: no frame is held out
  OnFailure on_failure = OnFailure::kRewind;
  int rewind_frames = 50;
  int restarts_per_frame = 5;
  DropReset reset = DropReset::kCounter;
  int hopeless_after = 0;
  /// Limit on the track calls of a mapping, in multiples of the number of frames. Without it, a
  /// system that never recovers would cost restarts_per_frame + 1 rewinds for each dropped frame.
  double max_effort = 6.0;
  int query_attempts = 5;
  Attempts attempts = Attempts::kSameFrame;
  int max_blank_frames = 30;
  double correct_distance_m = 0.25;
  double correct_angle_deg = 10.0;
  QueryTruth truth = QueryTruth::kLocal;
  friend bool operator==(const ProtocolConfig&, const ProtocolConfig&) = default;
};

/// Settings that affect only queries: maps do not depend on them.
inline constexpr const char* kProtocolOfQueries[] = {"query_attempts",    "attempts",
                                                     "max_blank_frames",  "correct_distance_m",
                                                     "correct_angle_deg", "truth"};

/// The settings of a live camera's feed: every frame is shown once, and none is held out.
inline ProtocolConfig live_feed() {
  ProtocolConfig config;
  config.test_interval = 0;
  config.on_failure = OnFailure::kContinue;
  return config;
}

template <MaybeConst<ProtocolConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [test_interval, on_failure, rewind_frames, restarts_per_frame, reset, hopeless_after,
         max_effort, query_attempts, attempts, max_blank_frames, correct_distance_m,
         correct_angle_deg, truth] = c;
  v("test_interval", test_interval, {0, 100000},
    "hold out every n-th frame as a test frame; 0: none");
  v("on_failure", on_failure, {},
    "when tracking is lost, the feed goes back (rewind) or on (continue)");
  v("rewind_frames", rewind_frames, {1, 100000}, "how far the feed goes back after a failure");
  v("restarts_per_frame", restarts_per_frame, {0, 1000},
    "failed restarts after which the failing frame is dropped");
  v("reset", reset, {},
    "after a dropped frame: reset the count of restarts (counter), or discard the map, too (map)");
  v("hopeless_after", hopeless_after, {0, 100000},
    "after this many frames dropped in a row, each frame is shown only once until one is tracked; "
    "0: never");
  v("max_effort", max_effort, {1, 1000},
    "mapping stops after this many track calls per frame of the sequence");
  v("query_attempts", query_attempts, {1, 1000}, "how many times a test frame is shown");
  v("attempts", attempts, {},
    "repeat the same frame (same_frame), or show the same view with new noise (new_noise)");
  v("max_blank_frames", max_blank_frames, {1, 100000},
    "blank frames shown until the system is lost, at most");
  v("correct_distance_m", correct_distance_m, setting::kLength_m,
    "largest position error of a correct answer");
  v("correct_angle_deg", correct_angle_deg, {0, 180}, "largest rotation error of a correct answer");
  v("truth", truth, {}, "what an answer is compared with: local or interpolated");
}

}  // namespace mh
