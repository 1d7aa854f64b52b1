// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/config/setting.hpp"

namespace mh {

struct MatchConfig {
  int max_distance = 50;         ///< bits; tight gate (appearance only, fusion)
  int max_distance_loose = 100;  ///< bits; loose gate where geometry already restricts the search
  double ratio = 0.75;           ///< largest ratio of best to second-best distance, appearance only
  double ratio_projection = 0.8;  ///< the same ratio where geometry already restricts the search
  friend bool operator==(const MatchConfig&, const MatchConfig&) = default;
};

template <MaybeConst<MatchConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [max_distance, max_distance_loose, ratio, ratio_projection] = c;
  v("max_distance", max_distance, setting::kBits,
    "bits; for matching by appearance alone and for fusion");
  v("max_distance_loose", max_distance_loose, setting::kBits,
    "bits; where geometry restricts the search");
  v("ratio", ratio, setting::kShare,
    "best over second-best distance, for matching by appearance alone");
  v("ratio_projection", ratio_projection, setting::kShare,
    "the same, where geometry restricts the search");
}

}  // namespace mh
