// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/report/results_table.hpp"
#include "bench/report/text_table.hpp"
#include "bench/report/wording.hpp"
#include "slam/config/slam.hpp"
#include "slam/io/counted.hpp"

namespace mh {
namespace {

/// The minimum and the maximum of some numbers.
struct Range {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  std::string text(int digits) const {
    const std::string low = fmt::format("{:.{}f}", least, digits),
                      high = fmt::format("{:.{}f}", most, digits);
    return low == high ? low : fmt::format("{} to {}", low, high);
  }
};

/// Describes the conditions under which the times were measured, since other work on the machine
/// affects them.
std::string circumstances(std::span<const RunResult> runs) {
  std::set<std::string> hosts, sessions;
  bool unknown = false;
  Range jobs, load;
  for (const RunResult& run : runs) {
    const Circumstances& c = run.circumstances;
    hosts.insert(c.host);
    unknown = unknown || c.session_start.empty();
    if (c.session_start.empty()) continue;
    sessions.insert(c.host + " " + c.session_start);
    jobs.add(c.jobs);
    load.add(c.load);
  }
  std::string text = fmt::format("  measured on {}", fmt::join(hosts, ", "));
  if (!sessions.empty())
    text += fmt::format(" in {}, {} side by side, load per processor {}",
                        counted(sessions.size(), "session"),
                        jobs.text(0) + (jobs.most == 1 ? " job" : " jobs"), load.text(1));
  if (unknown)
    text += sessions.empty() ? ", it is not known when" : ", others it is not known when";
  if (hosts.size() > 1 || sessions.size() > 1 || unknown) text += ": rows need not compare";
  return text + "\n";
}

}  // namespace

std::string times_table(const Suite& suite, std::span<const RunResult> runs) {
  const std::vector<Row> rows = make_rows(suite, runs);
  const std::vector<SharedSlamConfig> points = parameter_points(suite);
  const auto label = [&](const Row& row) {
    const SystemSpec& system = suite.systems[row.system];
    std::string text = fmt::format("{}, {}", suite.environments[row.environment].name, system.name);
    if (system.sees_labels()) text += ", " + with_labels(row.labels);
    if (suite.sweep.map == SweepMap::kRebuilt && system.takes_settings())
      text += ", " + shown_point(suite.sweep, settings_of(system, points[row.parameters]));
    return text;
  };
  TextTable table({"wall time, ms per call: median (p95)", "track", "relocalize"});
  for (const Row& row : rows) {
    if (suite.sweep.map == SweepMap::kFixed && row.parameters != 0) continue;  // same calls
    if (already_shown(suite, row)) continue;
    const auto cell = [](const TimeSummary& t) {
      if (t.p95_ms == 0) return std::string("-");  // no calls: the map came from the cache
      return fmt::format("{:.1f} ({:.1f})", t.median_ms, t.p95_ms);
    };
    table.add({label(row), cell(row.track), cell(row.relocalize)});
  }
  return table.text() + circumstances(runs);
}

}  // namespace mh
