// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/metrics/metrics_by_name.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bench/protocol/metrics/episode_summary.hpp"
#include "bench/protocol/metrics/mapping_counts.hpp"
#include "bench/protocol/metrics/trajectory_score.hpp"

namespace mh {

std::span<const Metric> all_metrics() {
  static const std::vector<Metric> all = [] {
    std::vector<Metric> metrics;
    for (const Figure& f : figures_of(TrajectoryScore())) metrics.push_back(f.metric);
    for (const Figure& f : figures_of(MappingCounts())) metrics.push_back(f.metric);
    for (const QuerySet set : kQuerySets)
      for (const Figure& f : figures_of(QuerySummary()))
        metrics.push_back(under(name(set), f.metric));
    for (const Figure& f : figures_of(EpisodeSummary()))
      metrics.push_back(under("episodes", f.metric));
    return metrics;
  }();
  return all;
}

Metric under(std::string_view questions, Metric metric) {
  metric.name = fmt::format("{}.{}", questions, metric.name);
  if (!metric.count.empty()) metric.count = fmt::format("{}.{}", questions, metric.count);
  return metric;
}

const Metric* find_metric(std::string_view name) {
  const auto found = std::ranges::find(all_metrics(), name, &Metric::name);
  return found == all_metrics().end() || found->better == Better::kNeither ? nullptr : &*found;
}

}  // namespace mh
