// SPDX-License-Identifier: Apache-2.0
#include "bench/results/table.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace mh {
namespace {

// Above this share of successes of the plain system nothing is left to be gained.
constexpr double kSaturated = 0.97;

const QuerySummary& summary(const Row& row, QuerySet set) {
  return set == QuerySet::kHeldOut ? row.held_out : row.second_tour;
}

std::string title(QuerySet set) {
  return set == QuerySet::kHeldOut ? "held-out frames (the paper's way)" : "second tour";
}

std::string metres(const std::optional<double>& value, int digits = 4) {
  return value ? fmt::format("{:.{}f}", *value, digits) : std::string("-");
}

std::string rule(std::size_t width) {
  return std::string(width, '-') + "\n";
}

/// Rows of one level and one kind of labels.
using Block = std::vector<const Row*>;

std::string table_2(const Block& block) {
  std::string text =
      fmt::format("  {:<44}{:>22}{:>22}\n", "", "Reloc. success (%)", "Average distance (m)");
  for (const QuerySet set : {QuerySet::kHeldOut, QuerySet::kSecondTour}) {
    if (summary(*block.front(), set).queries == 0) continue;
    text += fmt::format("  {}, {:.0f} queries\n", title(set), summary(*block.front(), set).queries);
    for (const Row* row : block) {
      const QuerySummary& s = summary(*row, set);
      const bool saturated = row->system == SystemKind::kPlain && s.success > kSaturated;
      text += fmt::format("    {:<42}{:>22.2f}{:>22}{}\n", name(row->system), 100 * s.success,
                          metres(s.distance_mean_m), saturated ? "   saturated" : "");
    }
  }
  text += "  published, other data (the paper's Table 2: a real house of 60 m2, YOLOv3 boxes)\n";
  text += fmt::format("    {:<42}{:>22}{:>22}\n", "Ours", "79.25", "0.0512");
  text += fmt::format("    {:<42}{:>22}{:>22}\n", "ORB-SLAM2", "71.43", "0.0945");
  return text;
}

std::string query_details(const Block& block, QuerySet set) {
  const char* heading = set == QuerySet::kHeldOut ? "held-out" : "2nd tour";
  std::string text =
      fmt::format("  {:<10}{:>9}{:>10}{:>9}{:>10}{:>11}{:>12}{:>10}\n", heading, "success",
                  "correct", "false", "mean m", "median m", "aligned m", "attempts");
  for (const Row* row : block) {
    const QuerySummary& s = summary(*row, set);
    text += fmt::format("  {:<10}{:>8.2f}%{:>9.2f}%{:>8.2f}%{:>10}{:>11}{:>12}{:>10.2f}\n",
                        name(row->system), 100 * s.success, 100 * s.correct, 100 * s.wrong,
                        metres(s.distance_mean_m), metres(s.distance_median_m),
                        metres(s.aligned_distance_mean_m), s.attempts);
  }
  return text;
}

/// Keyframes left after the steps of Algorithm 1, as counts and as shares of the map.
std::string candidate_details(const Block& block, QuerySet set) {
  const char* heading = set == QuerySet::kHeldOut ? "held-out" : "2nd tour";
  std::string text = fmt::format("  {:<10}{:>10}{:>18}{:>18}{:>18}{:>18}{:>11}{:>13}\n", heading,
                                 "keyframes", "after eq. 3", "after eq. 4", "after eq. 5",
                                 "after eq. 6", "one left", "label mass");
  for (const Row* row : block) {
    const QuerySummary& s = summary(*row, set);
    const auto left = [&](double count) {
      return fmt::format("{:.2f} ({:.2f}%)", count, 100 * count / std::max(1.0, s.keyframes));
    };
    text += fmt::format("  {:<10}{:>10.0f}{:>18}{:>18}{:>18}{:>18}{:>10.1f}%{:>12.1f}%\n",
                        name(row->system), s.keyframes, left(s.c1), left(s.c2), left(s.c3),
                        left(s.final), 100 * s.single_candidate, 100 * s.label_mass);
  }
  return text;
}

std::string failing_stages(const Block& block) {
  std::string text;
  for (const Row* row : block)
    for (const QuerySet set : {QuerySet::kHeldOut, QuerySet::kSecondTour}) {
      std::map<RelocalizationStage, int> stages;
      for (const RunResult* run : row->trials)
        for (const QueryScore& q : queries(*run, set))
          if (!q.success) ++stages[q.answer.stage];
      if (stages.empty()) continue;
      text += fmt::format("  {}, {}: failed at", name(row->system), name(set));
      for (const auto& [stage, count] : stages) text += fmt::format(" {} {}", name(stage), count);
      text += "\n";
    }
  return text;
}

std::string mapping_details(const Block& block) {
  std::string text =
      fmt::format("  {:<10}{:>10}{:>14}{:>11}{:>12}{:>11}{:>10}{:>9}{:>18}{:>18}\n", "mapping",
                  "ATE m", "first pose m", "RPE m/fr", "RPE m/s", "complete", "restarts", "dropped",
                  "track ms (p95)", "reloc ms (p95)");
  for (const Row* row : block) {
    const TrajectoryScore& t = row->trajectory;
    text += fmt::format(
        "  {:<10}{:>10}{:>14}{:>11}{:>12}{:>10.2f}%{:>10.0f}{:>9.0f}{:>18}{:>18}\n",
        name(row->system), metres(t.ate_rmse_m), metres(t.ate_first_pose_m),
        metres(t.rpe_frame_rmse_m, 5), metres(t.rpe_second_rmse_m, 5), 100 * t.completeness,
        row->restarts, row->dropped,
        fmt::format("{:.1f} ({:.1f})", row->track.median_ms, row->track.p95_ms),
        fmt::format("{:.1f} ({:.1f})", row->relocalize.median_ms, row->relocalize.p95_ms));
  }
  return text;
}

std::string penalties(const Block& block) {
  std::string text;
  for (const Row* row : block) {
    if (row->system == SystemKind::kPlain) continue;
    text += "  pairs penalised by xi (of those compared; rejected by it; ratio tests it helped)\n";
    for (std::size_t m = 0; m < row->matches.size(); ++m) {
      const MatcherCounts& c = row->matches[m];
      const double share = c.compared > 0 ? 100.0 * static_cast<double>(c.penalised) /
                                                static_cast<double>(c.compared)
                                          : 0.0;
      text +=
          fmt::format("    {:<26}{:>14}  ({:5.1f}% of {}; {}; {})\n", name(static_cast<Matcher>(m)),
                      c.penalised, share, c.compared, c.rejected_by_xi, c.ratio_helped);
    }
  }
  return text;
}

std::string common_ate(const Block& block, const Trajectory& truth) {
  const Row *semantic = nullptr, *plain = nullptr;
  for (const Row* row : block) (row->system == SystemKind::kPlain ? plain : semantic) = row;
  if (semantic == nullptr || plain == nullptr) return "";
  const auto [a, b] = ate_over_common_frames(*semantic, *plain, truth);
  return fmt::format("  ATE over the frames that both tracked, m: semantic {}, plain {}\n",
                     metres(a), metres(b));
}

std::string comparison_line(const Comparison& c) {
  const Verdict v = verdict(c);
  const std::string word =
      v == Verdict::kFirstBetter    ? "semantic is better"
      : v == Verdict::kSecondBetter ? "plain is better"
      : std::isfinite(c.detectable)
          ? fmt::format("undecided; smallest detectable difference {:.4f}", c.detectable)
          : std::string("undecided; too few queries");
  return fmt::format("  {:<62}{:+.4f} [{:+.4f}, {:+.4f}]  p = {:.4f} (Holm {:.4f})  {}\n", c.what,
                     c.difference, c.low, c.high, c.p, c.p_holm, word);
}

}  // namespace

std::string results_table(const Suite& suite, const World& world,
                          const std::vector<RunResult>& runs) {
  const std::vector<Row> rows = make_rows(suite, runs);
  const auto comparisons = compare_systems(suite, rows);
  std::string text;
  for (std::size_t level = 0; level < suite.levels.size(); ++level) {
    for (const LabelMode labels : suite.labels) {
      Block block;
      for (const Row& row : rows)
        if (row.level == level && row.labels == labels) block.push_back(&row);
      if (block.empty()) continue;
      text += fmt::format("\n{}, level {}, {} labels, {} trial{}{}\n", suite.name,
                          level_name(suite.levels[level]), name(labels), suite.trials,
                          suite.trials == 1 ? "" : "s (medians)",
                          world.frames ? fmt::format(", first {} frames", *world.frames) : "");
      text += rule(90) + table_2(block) + rule(90);
      for (const QuerySet set : {QuerySet::kHeldOut, QuerySet::kSecondTour})
        if (summary(*block.front(), set).queries > 0)
          text += query_details(block, set) + candidate_details(block, set);
      text += failing_stages(block) + mapping_details(block) +
              common_ate(block, world.mapping.camera) + penalties(block);
    }
    if (comparisons[level].empty()) continue;
    text += fmt::format(
        "\nsemantic minus plain, level {}: blocks of queries resampled, 95 % intervals, Holm over "
        "these {} comparisons\n",
        level_name(suite.levels[level]), comparisons[level].size());
    if (suite.trials == 1)
      text += "  one trial: this holds for these maps; other seeds draw other maps (--trials 10)\n";
    for (const Comparison& c : comparisons[level]) text += comparison_line(c);
  }
  return text;
}

}  // namespace mh
