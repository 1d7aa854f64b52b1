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

// What the paper reports about relocalization in a real house of 60 m², with labels from YOLOv3's
// boxes. No suite uses these data; the figures are shown for reference.

/// A row of the paper's Table 2.
struct PublishedRow {
  std::string_view system;
  double success = 0;  ///< share of the queries
  double distance_mean_m = 0;
};
inline constexpr PublishedRow kPublishedTable2[] = {{"the paper's system", 0.7925, 0.0512},
                                                    {"ORB-SLAM2", 0.7143, 0.0945}};

/// From the paper's section 3.3.3: the keyframes left after each of the three steps, as shares of
/// the map; the number of keyframes left at the end; and the share of queries with exactly one
/// keyframe left. Section 2.3 says that the steps are equations 3 to 5, but the third share may be
/// the one after equation 6.
struct PublishedCandidates {
  std::string_view system;
  double c1 = 0, c2 = 0, c3 = 0, final = 0, single = 0;
};
inline constexpr PublishedCandidates kPublishedCandidates[] = {
    {"the paper's system", 0.9936, 0.0218, 0.0093, 1.89, 0.6618}};

/// The published rows to show below a suite's own rows; none unless the suite names the table.
inline std::span<const PublishedRow> published_rows(const Suite& suite) {
  if (suite.published != Published::kTable2) return {};
  return kPublishedTable2;
}
inline std::span<const PublishedCandidates> published_candidates(const Suite& suite) {
  if (suite.published != Published::kTable2) return {};
  return kPublishedCandidates;
}

/// ATE (RMSE, m) by environment, for the suite's systems and for published ones.
struct AteBesidePublished {
  std::vector<std::string> systems;  ///< the suite's systems, then the published ones
  std::vector<std::string> environments;
  std::vector<std::vector<std::optional<double>>> ate_m;  ///< by environment, then by system
};
/// Empty unless the suite states published values (Suite::published_ate_m). For the suite's
/// systems, the median over trials at the first level, kind of labels and parameter point.
AteBesidePublished ate_beside_published(const Suite& suite, std::span<const Row> rows);

}  // namespace mh
