// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace mh {

/// Counts the similarities in all sums of equation 5, and among them those that were computed for
/// an earlier query or never. Similarities of keyframes that share nothing with the query are not
/// counted: they are 0 by definition.
struct SummedScores {
  int terms = 0;
  int unscored = 0;         ///< 0, since no query ever computed them (NeighborScores)
  int stale = 0;            ///< left by an earlier query (NeighborScores::kAsReleased)
  double weight = 0;        ///< sum of all terms
  double stale_weight = 0;  ///< sum of the stale terms
  std::int64_t stale_age =
      0;  ///< for each stale term, the number of queries since it was computed; summed
};

/// Keyframes left after each step of Algorithm 1.
struct CandidateCounts {
  int keyframes = 0;           ///< in the map
  int c1 = 0, c2 = 0, c3 = 0;  ///< after equations 3, 4 and 5
  int final = 0;               ///< after equation 6
  double label_mass = 0;       ///< share of the query vector's L1 mass that comes from labels
  SummedScores summed;
};

}  // namespace mh
