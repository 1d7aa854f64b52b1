// SPDX-License-Identifier: Apache-2.0
#include "bench/report/pages/curves.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "bench/report/pages/page_table.hpp"
#include "bench/report/pages/tables.hpp"
#include "bench/report/wording.hpp"
#include "bench/results/graded.hpp"
#include "bench/results/sweep_results.hpp"
#include "scenes/generate/generate.hpp"
#include "slam/config/slam.hpp"
#include "slam/core/interpolate.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

/// Sum and number of errors of one window.
struct Sum {
  double sum = 0;
  std::size_t count = 0;
  void add(double value) { sum += value, ++count; }
  double mean() const { return sum / static_cast<double>(count); }
};

/// The frame of the tour that each pose of a run's estimate belongs to. It is found from the calls
/// that mapped the pose; for a program that returned only a trajectory, from the frames of a
/// simulated truth; otherwise, by counting poses.
std::vector<std::size_t> frames_of_estimate(const RunResult& run) {
  std::map<Stamp, std::size_t> frame_at;
  for (const MappedFrame& call : run.mapping.calls) frame_at.emplace(call.stamp_ns, call.index);
  if (frame_at.empty() && run.truth.size() == run.place.mapping.frames)
    for (std::size_t i = 0; i < run.truth.size(); ++i) frame_at.emplace(run.truth[i].stamp_ns, i);
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < run.estimate.size(); ++i) {
    const auto found = frame_at.find(run.estimate[i].stamp_ns);
    frames.push_back(found == frame_at.end() ? i : found->second);
  }
  return frames;
}

/// Mean position error of a run for each window of frames; a window without a tracked frame has a
/// count of 0. The truth of a recording is interpolated to the frames.
std::vector<Sum> window_errors(const RunResult& run) {
  std::vector<Sum> windows;
  const std::vector<std::size_t> frames = frames_of_estimate(run);
  for (std::size_t i = 0; i < run.estimate.size(); ++i) {
    const auto truth = interpolated_pose(run.truth, run.estimate[i].stamp_ns, kMaxTruthGap_ns);
    if (!truth) continue;
    const Eigen::Vector3d at =
        run.alignment.truth_from_estimate * run.estimate[i].world_from_camera.translation();
    const std::size_t window = frames[i] / kWindow;
    if (windows.size() <= window) windows.resize(window + 1);
    windows[window].add((at - truth->translation()).norm());
  }
  return windows;
}

/// The 97.5 % quantile of Student's t, by Abramowitz and Stegun, 26.7.5: accurate to 0.1 % with at
/// least 4 degrees of freedom.
double student_t(double degrees_of_freedom) {
  const double z = 1.959964, n = degrees_of_freedom, z2 = z * z;
  return z * (1 + (z2 + 1) / (4 * n) + ((5 * z2 + 16) * z2 + 3) / (96 * n * n) +
              (((3 * z2 + 19) * z2 + 17) * z2 - 15) / (384 * n * n * n));
}

/// Each curve starts as a mean over all environments. Where fewer environments than this are left,
/// the mean is not comparable with the start of the curve.
constexpr std::size_t kFewestCounted = 5;

struct Curve {
  std::size_t system = 0;
  std::string level, labels;
  auto operator<=>(const Curve&) const = default;
};

}  // namespace

Json error_by_frame_json(const Suite& suite, std::span<const Row> rows) {
  // Sums over trials, by curve, window and environment.
  std::map<Curve, std::vector<std::map<std::size_t, Sum>>> all;
  for (const Row& row : rows) {
    if (row.parameters != 0 || !is_own_row(suite, row.system, row.labels)) continue;
    for (const Trial& trial : row.trials) {
      const std::vector<Sum> windows = window_errors(*trial.run);
      auto& curve = all[{row.system, level_name(suite.levels[row.level]),
                         labels_seen(suite, row.system, row.labels)}];
      if (curve.size() < windows.size()) curve.resize(windows.size());
      for (std::size_t w = 0; w < windows.size(); ++w)
        if (windows[w].count > 0) curve[w][row.environment].add(windows[w].mean());
    }
  }
  PageTable table(
      "Figure 4: error against frames",
      fmt::format("Mean position error after SE(3) alignment over windows of {} frames, "
                  "over the environments still counted, as far as they are at least {}, or all; "
                  "95 % interval of the mean by Student's t.",
                  kWindow, kFewestCounted));
  for (const auto& [curve, windows] : all)
    for (std::size_t w = 0; w < windows.size(); ++w) {
      if (windows[w].empty()) continue;
      Sum sum, squares;
      for (const auto& [environment, trials] : windows[w]) sum.add(trials.mean());
      for (const auto& [environment, trials] : windows[w])
        squares.add(std::pow(trials.mean() - sum.mean(), 2));
      const double n = static_cast<double>(sum.count);
      std::optional<double> half;
      if (sum.count >= kFewestCounted)
        half = student_t(n - 1) * std::sqrt(squares.sum / (n - 1) / n);
      const bool enough = sum.count >= std::min(kFewestCounted, windows.front().size());
      table.begin_row();
      table.text({"system", "system"}, suite.systems[curve.system].name);
      table.text({"level", "level"}, curve.level);
      table.text({"labels", "labels"}, curve.labels);
      table.number({"frame", "frame"}, static_cast<double>(w * kWindow) + 0.5 * kWindow);
      table.number({"error_m", "mean error", "m", 4},
                   enough ? std::optional(sum.mean()) : std::nullopt);
      table.number({"low", "low", "m", 4},
                   half ? std::optional(std::max(0.0, sum.mean() - *half)) : std::nullopt);
      table.number({"high", "high", "m", 4},
                   half ? std::optional(sum.mean() + *half) : std::nullopt);
      table.number({"scenes", "environments counted"}, n);
    }
  return table.rows() > 0 ? table.json() : Json();
}

Json density_json(const Suite& suite, std::span<const Row> rows) {
  std::map<std::size_t, double> density_of;
  for (std::size_t e = 0; e < suite.environments.size(); ++e)
    if (const std::string scene = suite.environments[e].scene.string();
        scene.starts_with(kGeneratedPrefix))
      density_of[e] = generate_plan(parse_generated(scene)).objects_per_10_m2();
  if (density_of.empty()) return nullptr;
  PageTable table("Figure 3: by density of objects",
                  "Per environment the median over trials; objects per 10 m² of floor.");
  for (const Row& row : rows) {
    const auto density = density_of.find(row.environment);
    if (density == density_of.end() || row.parameters != 0 || row.trials.empty() ||
        !is_own_row(suite, row.system, row.labels))
      continue;
    table.begin_row();
    table.text({"environment", "environment"}, suite.environments[row.environment].name);
    table.text({"system", "system"}, suite.systems[row.system].name);
    table.text({"level", "level"}, level_name(suite.levels[row.level]));
    table.text({"labels", "labels"}, labels_seen(suite, row.system, row.labels));
    table.number({"density", "objects per 10 m²", "", 1}, density->second);
    table.text({"group", "group"}, density_group_name(density_group(density->second)));
    table.figures(figures_of(row.trajectory));
    for (const QuerySet set : kQuerySets)
      if (summary(row, set).queries > 0)
        table.figures(figures_of(summary(row, set)), fmt::format("{}.", name(set)),
                      fmt::format("{}: ", short_title(set)));
  }
  Json groups = Json::array();
  for (int g = 0; g < kDensityGroups; ++g) groups.push_back(density_group_name(g));
  return {{"table", table.json()}, {"groups", groups}};
}

Json sweep_pages_json(const Suite& suite, std::span<const Row> rows) {
  if (suite.sweep.points.empty()) return nullptr;
  PageTable table(
      "Sweep",
      fmt::format("Map: {}. Shares with Wilson's 95 % interval, as if queries were independent.",
                  name(suite.sweep.map)));
  Json best = Json::array();
  for (const SweepResult& result : sweep_results(suite, rows))
    for (const QuerySet set : kQuerySets) {
      for (std::size_t p = 0; p < result.points.size(); ++p) {
        const QuerySummary& s = summary(result.answers[p], set);
        if (s.queries == 0) continue;
        const SlamConfig at = settings_of(suite.systems[result.system], result.points[p]);
        const double asked = s.queries * static_cast<double>(result.answers[p].scenes);
        table.begin_row();
        table.text({"system", "system"}, suite.systems[result.system].name);
        table.text({"level", "level"}, level_name(suite.levels[result.level]));
        table.text({"labels", "labels"}, name(result.labels));
        table.text({"query_set", "queries"}, name(set));
        table.number({"point", "point"}, static_cast<double>(p));
        for (const std::string& varied : suite.sweep.varied)
          table.text({"at:" + varied, std::string(shown_name(varied))}, shown_value(at, varied));
        table.number({"asked", "asked"}, asked);
        const auto share = [&](const char* key, const char* title,
                               const std::optional<double>& value) {
          table.number({key, title, "%", 2}, value);
          if (!value) return;
          const auto [low, high] = wilson(*value * asked, asked);
          table.number({fmt::format("{}.low", key), fmt::format("{}, low", title), "%", 2}, low);
          table.number({fmt::format("{}.high", key), fmt::format("{}, high", title), "%", 2}, high);
        };
        share("success", "success", s.success);
        share("correct", "correct", s.correct);
        share("false_positive", "false pos.", s.false_positive);
        table.number({"distance_mean_m", "mean distance", "m", 4}, s.distance_mean_m);
        table.number({"final", "candidates", "", 2}, s.final);
      }
      const auto found = best_point(suite, rows, result, set);
      if (!found || found->equals == result.points.size()) continue;
      const SystemSpec& system = suite.systems[result.system];
      const Comparison& c = found->to_reference;
      best.push_back(fmt::format(
          "{}, {}, {}: most correct answers at {}{} ({:.2f} %){}", system.name,
          with_labels(result.labels), name(set),
          shown_point(suite.sweep, settings_of(system, result.points[found->point])),
          found->equals > 1 ? fmt::format(", one of {} equal points", found->equals) : "",
          100 * summary(result.answers[found->point], set).correct.value_or(0),
          c.pairs == 0 || !std::isfinite(c.low)
              ? std::string(".")
              : fmt::format(
                    "; {:+.2f} percentage points, 95 % interval {:+.2f} to {:+.2f}, from {}. "
                    "Chosen by the same queries: confirm it on others.",
                    100 * c.difference, 100 * c.low, 100 * c.high,
                    shown_point(suite.sweep,
                                settings_of(system, result.points[found->reference])))));
    }
  if (table.rows() == 0) return nullptr;
  Json varied = Json::array();
  for (const std::string& setting : suite.sweep.varied) varied.push_back("at:" + setting);
  return {{"table", table.json()}, {"varied", varied}, {"best", best}};
}

}  // namespace mh
