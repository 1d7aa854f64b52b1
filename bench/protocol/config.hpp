// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace mh {

/// What "resets" means after a frame was dropped (section 3.1 of the paper leaves it open).
enum class DropReset {
  kCounter,  ///< the count of failed restarts starts again, the map stays
  kMap,      ///< the system forgets its map too
};

/// What a query's answer is compared with.
enum class QueryTruth {
  kLocal,  ///< the nearest mapped frame's estimate, carried on by the true motion to the query
  /// Between the estimates of the mapped frames before and after, by time (section 3.2 of the
  /// paper: "based on the camera poses with neighboring frames"). Needs no truth at all, but takes
  /// the estimates' own errors for it. Where there are no two near neighbors: kLocal.
  kInterpolated,
};

/// The paper's sections 3.1 and 3.2, each number settable.
struct ProtocolConfig {
  int test_interval = 30;      ///< every so many frames one is held out as a test frame, >= 2
  int rewind_frames = 50;      ///< how far the feed goes back after a failure, >= 1
  int restarts_per_frame = 5;  ///< failed restarts after which the offending frame is dropped, >= 0
  DropReset reset = DropReset::kCounter;
  /// Mapping gives up after this many track calls per frame of the sequence: a system that never
  /// finds its way back would otherwise cost restarts_per_frame + 1 rewinds for each frame dropped.
  double max_effort = 6.0;

  int query_attempts = 5;     ///< times that a test frame is shown, >= 1
  int max_blank_frames = 30;  ///< blank frames shown at most until the system is lost, >= 1
  double correct_distance_m = 0.25;
  double correct_angle_deg = 10.0;
  QueryTruth truth = QueryTruth::kLocal;
};

}  // namespace mh
