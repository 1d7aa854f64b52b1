// SPDX-License-Identifier: Apache-2.0
#include "bench/report/results_table.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/report/episodes_report.hpp"
#include "bench/report/graded_report.hpp"
#include "bench/report/place_table.hpp"
#include "bench/report/recordings_text.hpp"
#include "bench/report/scenes_table.hpp"
#include "bench/report/sweep_table.hpp"
#include "bench/report/text_table.hpp"
#include "bench/results/published.hpp"
#include "bench/suite/parameters.hpp"
#include "bench/suite/run_spec.hpp"
#include "slam/config/slam.hpp"
#include "slam/io/counted.hpp"

namespace mh {
namespace {

/// The warning that tours were cut, which is printed above all tables.
std::string warning_of_cut(const Suite& suite, std::span<const RunResult> runs) {
  const auto cut = std::ranges::find_if(runs, [](const RunResult& run) { return run.place.cut; });
  if (cut == runs.end()) return "";
  return fmt::format(
      "\nSHORTENED to the first {} of each tour: a quick look, not a result of this suite\n",
      counted(*suite.max_frames, "frame"));
}

std::string base_text(const Suite& suite) {
  std::vector<std::string> lines = base_lines(suite);
  for (const Sense sense : suite.senses)
    lines.push_back(
        fmt::format("senses: {}, besides the camera, while mapping", name_of(sense, words(sense))));
  return lines.empty() ? "" : fmt::format("\n{}\n", fmt::join(lines, "\n"));
}

/// Lists the failed runs, which the table above does not include, with their errors.
std::string failures_text(std::span<const FailedRun> failed) {
  if (failed.empty()) return "";
  std::string text = fmt::format("\nfailed, so the figures above do not include {}:\n",
                                 counted(failed.size(), "run"));
  for (const FailedRun& run : failed) text += fmt::format("  {}: {}\n", run.spec.name, run.error);
  return text;
}

/// Lists runs of the suite that have not been made yet.
std::string missing_text(std::span<const std::string> missing) {
  if (missing.empty()) return "";
  constexpr std::size_t kMost = 10;
  std::string text = fmt::format("\nmissing, so the figures above do not include {}:\n",
                                 counted(missing.size(), "run"));
  for (std::size_t i = 0; i < std::min(kMost, missing.size()); ++i)
    text += fmt::format("  {}\n", missing[i]);
  if (missing.size() > kMost) text += fmt::format("  and {} more\n", missing.size() - kMost);
  return text;
}

}  // namespace

std::vector<std::string> base_lines(const Suite& suite) {
  if (std::ranges::none_of(suite.systems, &SystemSpec::takes_settings)) return {};
  const RelocalizeConfig& relocalize = suite.slam->relocalize;
  std::vector<std::string> lines{
      relocalize.acceptance == Acceptance::kOrbSlam2
          ? "base: orb_slam2: poses of relocalization are accepted as ORB-SLAM2 accepts them"
          : "base: ours: poses of relocalization are accepted by the rule of docs/slam.md"};
  bool as_released = relocalize.neighbor_scores == NeighborScores::kAsReleased;
  std::vector<std::string> variants;
  for (const SystemSpec& system : suite.systems) {
    if (system.settings.empty()) continue;
    const SlamConfig own = settings_of(system, *suite.slam);
    as_released |= own.relocalize.neighbor_scores == NeighborScores::kAsReleased;
    std::vector<std::string> changes;
    for (const auto& [setting, value] : system.settings)
      changes.push_back(fmt::format("{} {}", shown_name(setting), shown_value(own, setting)));
    variants.push_back(
        fmt::format("{}: {}, {}", system.name, name(system.kind), fmt::join(changes, ", ")));
  }
  if (as_released)
    lines.emplace_back(
        "neighbor scores as ORB-SLAM2 released them: answers depend on the order of queries");
  lines.insert(lines.end(), variants.begin(), variants.end());
  return lines;
}

namespace {

/// The table of ATE beside published ATE; empty unless the suite states published values.
std::string published_text(const AteBesidePublished& table) {
  if (table.environments.empty()) return "";
  std::vector<std::string> headings{"ATE m"};
  headings.insert(headings.end(), table.systems.begin(), table.systems.end());
  TextTable text(std::move(headings));
  for (std::size_t e = 0; e < table.environments.size(); ++e) {
    std::vector<std::string> cells{table.environments[e]};
    for (const std::optional<double>& ate_m : table.ate_m[e])
      cells.push_back(ate_m ? fmt::format("{:.4f}", *ate_m) : "-");
    text.add(std::move(cells));
  }
  return "\nbeside published ATE, for which all frames were mapped\n" + text.text();
}

std::string main_table(const Suite& suite, std::span<const Row> rows, Extent extent) {
  return (parameter_points(suite).size() > 1 ? sweep_table(suite, rows)
          : suite.environments.size() > 1    ? scenes_table(suite, rows, extent)
                                             : place_table(suite, rows, extent)) +
         published_text(ate_beside_published(suite, rows));
}

/// What the tables' words mean, in a line.
std::string terms(const Suite& suite, std::span<const Row> rows) {
  const bool asked = std::ranges::any_of(rows, [](const Row& row) {
    return std::ranges::any_of(kQuerySets,
                               [&](QuerySet set) { return summary(row, set).queries > 0; });
  });
  if (!asked) return "";
  return fmt::format(
      "\nsuccess: a pose; correct: within {:g} m and {:g} deg; where mapped: success where a "
      "mapped frame is near\n",
      suite.protocol.correct_distance_m, suite.protocol.correct_angle_deg);
}

}  // namespace

std::string results_table(const Suite& suite, std::span<const RunResult> runs,
                          std::span<const FailedRun> failed, std::span<const std::string> missing) {
  const std::vector<Row> rows = make_rows(suite, runs, failed);
  return warning_of_cut(suite, runs) + episodes_table(suite, runs) +
         main_table(suite, rows, Extent::kWhole) + graded_table(suite, rows) + base_text(suite) +
         recordings_text(suite, runs) + failures_text(failed) + missing_text(missing);
}

std::string results_screen(const Suite& suite, std::span<const RunResult> runs,
                           std::span<const FailedRun> failed,
                           std::span<const std::string> missing) {
  const std::vector<Row> rows = make_rows(suite, runs, failed);
  const std::string tables = suite.episodes
                                 ? episodes_table(suite, runs)
                                 : main_table(suite, rows, Extent::kScreen) + terms(suite, rows);
  return warning_of_cut(suite, runs) + tables + failures_text(failed) + missing_text(missing);
}

}  // namespace mh
