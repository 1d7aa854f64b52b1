// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace mh {

/// Scores that earlier relocalizations stored with the keyframes of a map: ORB-SLAM2's mRelocScore
/// (NeighborScores::kAsReleased).
struct StaleScores {
  struct Score {
    double similarity = 0;   ///< to the last query for which the keyframe passed equation 4
    std::int32_t query = 0;  ///< the number of that query, from 1; 0: there was none
  };
  std::vector<Score> of;     ///< of each keyframe, by id
  std::int32_t queries = 0;  ///< number of queries so far
};

}  // namespace mh
