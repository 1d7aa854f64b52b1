// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/results/rows.hpp"
#include "bench/suite/suite.hpp"

namespace mh {

// What the paper reports about relocalization, in a real house of 60 m² with labels from YOLOv3's
// boxes: different data from any suite's, shown for reference.

/// A row of its Table 2.
struct PublishedRow {
  std::string_view system;
  double success = 0;  ///< share of the queries
  double distance_mean_m = 0;
};
inline constexpr PublishedRow kTable2[] = {{"the paper's semantic system", 0.7925, 0.0512},
                                           {"ORB-SLAM2", 0.7143, 0.0945}};

/// From its section 3.3.3: keyframes left after each of the three steps, as shares of the map;
/// their number at the end; and the share of queries with exactly one left. Section 2.3 calls
/// equations 3 to 5 the steps, but the third share may be that after equation 6.
struct PublishedCandidates {
  std::string_view system;
  double c1 = 0, c2 = 0, c3 = 0, final = 0, single = 0;
};
inline constexpr PublishedCandidates kCandidates[] = {
    {"the paper's semantic system", 0.9936, 0.0218, 0.0093, 1.89, 0.6618}};

/// The rows to show below those of a suite: none unless the suite names the table.
inline std::span<const PublishedRow> published_rows(const Suite& suite) {
  if (suite.published != Published::kTable2) return {};
  return kTable2;
}
inline std::span<const PublishedCandidates> published_candidates(const Suite& suite) {
  if (suite.published != Published::kTable2) return {};
  return kCandidates;
}

/// ATE (RMSE, m) by environment, for the suite's systems and for published ones.
struct AteBesidePublished {
  std::vector<std::string> systems;  ///< the suite's, then the others
  std::vector<std::string> environments;
  std::vector<std::vector<std::optional<double>>> ate_m;  ///< by environment, then by system
};
/// Empty unless the suite states published values (Suite::published_ate_m). For the suite's
/// systems, the median over trials at the first level, kind of labels and parameter point.
AteBesidePublished ate_beside_published(const Suite& suite, std::span<const Row> rows);

}  // namespace mh
