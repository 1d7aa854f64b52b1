// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "slam/io/fields.hpp"

namespace mh {

/// How far a graded query is from what was mapped. Every field is absent for queries of the other
/// sets.
struct QueryGrade {
  // Distance and angle to the nearest frame offered for mapping; to find the nearest, 1 rad counts
  // as 1 m (as for NearestBy::kPlace). From true poses, hence the same for every system.
  std::optional<double> mapped_m = {}, mapped_deg = {};
  std::optional<double> shown = {};  ///< share of the visible surface that mapped frames show
  /// Playback speed of a handheld scan, 1 = as recorded; absent if the camera is at rest.
  std::optional<double> speed = {};
  friend bool operator==(const QueryGrade&, const QueryGrade&) = default;
};

template <MaybeConst<QueryGrade> G, class Visit>
void fields(G& grade, Visit& v) {
  auto& [mapped_m, mapped_deg, shown, speed] = grade;
  v("mapped_m", mapped_m);
  v("mapped_deg", mapped_deg);
  v("shown", shown);
  v("speed", speed);
}

}  // namespace mh
