// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "slam/io/fields.hpp"

namespace mh {

/// How far a graded query is from what was mapped. Absent for queries of the other sets.
struct QueryGrade {
  // To the truly nearest frame that was offered for mapping, 1 rad equivalent to 1 m (as for
  // NearestBy::kPlace): true poses, so that they are the same for every system.
  std::optional<double> mapped_m = {}, mapped_deg = {};
  std::optional<double> shown = {};  ///< share of the surface in sight that a mapped frame shows
  std::optional<double> speed = {};  ///< playback speed of a handheld scan, 1 = as
                                     ///< recorded; absent: standing still
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
