// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "bench/protocol/metrics/query_summary.hpp"
#include "bench/results/published.hpp"

namespace mh {

/// A column of Table 2 (relocalization). Text shows only the columns that have a `text_heading`;
/// pages, their data and figures show all columns.
struct Table2Column {
  std::string_view key;
  std::string_view title;
  std::string_view unit;  ///< "m"; "%": a share, stored as 0 to 1 and printed times 100
  int decimals = 0;
  std::optional<double> (*measured)(const QuerySummary&);
  double PublishedRow::*published = nullptr;  ///< null if the paper's table lacks this column
  std::string_view text_heading = {};         ///< the paper's words if its table has this column
};

inline constexpr Table2Column kTable2Columns[] = {
    {"queries", "queries per environment", "", 1,
     [](const QuerySummary& s) { return std::optional(s.queries); }},
    {"success", "success", "%", 2, [](const QuerySummary& s) { return std::optional(s.success); },
     &PublishedRow::success, "Reloc. success (%)"},
    {"success_in_map", "success where mapped", "%", 2,
     [](const QuerySummary& s) { return s.success_in_map; }, nullptr, "Where mapped (%)"},
    {"correct", "correct", "%", 2, [](const QuerySummary& s) { return s.correct; }, nullptr,
     "Correct (%)"},
    {"false_positive", "false pos.", "%", 2,
     [](const QuerySummary& s) { return s.false_positive; }},
    {"distance_mean_m", "mean distance", "m", 4,
     [](const QuerySummary& s) { return s.distance_mean_m; }, &PublishedRow::distance_mean_m,
     "Average distance (m)"},
    {"distance_median_m", "median distance", "m", 4,
     [](const QuerySummary& s) { return s.distance_median_m; }},
    {"attempts", "attempts", "", 2,
     [](const QuerySummary& s) { return std::optional(s.attempts); }}};

/// A number of a column as printed; "-" if unknown.
inline std::string shown(const Table2Column& column, std::optional<double> value) {
  return value ? fmt::format("{:.{}f}", (column.unit == "%" ? 100 : 1) * *value, column.decimals)
               : "-";
}

}  // namespace mh
