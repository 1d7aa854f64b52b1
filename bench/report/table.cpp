// SPDX-License-Identifier: Apache-2.0
#include "bench/report/table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/results/sweep.hpp"
#include "slam/core/counted.hpp"

namespace mh {
namespace {

// Above this share of successes of a system without labels nothing is left to be gained by them.
constexpr double kSaturated = 0.97;

std::string title(QuerySet set) {
  return set == QuerySet::kHeldOut ? "held-out frames (the paper's way)" : "second tour";
}

std::string meters(const std::optional<double>& value, int digits = 4) {
  return value ? fmt::format("{:.{}f}", *value, digits) : std::string("-");
}

/// "87.30%"; "-" where nothing was asked, as of a program that answers with a trajectory alone.
std::string percent(const QuerySummary& s, double QuerySummary::*share) {
  return s.queries > 0 ? fmt::format("{:.2f}%", 100 * s.*share) : std::string("-");
}

/// The same where nobody may know.
std::string percent(const QuerySummary& s, std::optional<double> QuerySummary::*share) {
  return s.*share ? fmt::format("{:.2f}%", 100 * *(s.*share)) : std::string("-");
}

/// Queries put to the system that was asked most.
double most_queries(const std::vector<const Row*>& rows, QuerySet set) {
  double most = 0;
  for (const Row* row : rows) most = std::max(most, summary(*row, set).queries);
  return most;
}
bool asked(const std::vector<CategoryRow>& rows, QuerySet set) {
  return std::any_of(rows.begin(), rows.end(),
                     [&](const CategoryRow& row) { return summary(row, set).queries > 0; });
}

/// Least and greatest of some numbers.
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

std::string rule(std::size_t width) {
  return std::string(width, '-') + "\n";
}

/// Rows that differ in nothing but the system.
struct Block {
  const Suite& suite;
  std::span<const Row> all;  ///< of the whole table
  std::vector<const Row*> rows;
  /// Those with details of their own: without the plain system where a block above told them.
  std::vector<const Row*> detailed;
  const SystemSpec& system(const Row* row) const { return suite.systems[row->system]; }
};

/// ", first 200 frames" behind what was cut; empty otherwise.
std::string shortened(const Suite& suite, std::span<const Row> rows) {
  const bool cut = std::ranges::any_of(rows, [](const Row& row) {
    return std::ranges::any_of(row.trials, [](const Trial& t) { return t.run->place.cut; });
  });
  return cut ? fmt::format(", first {}", counted(*suite.max_frames, "frame")) : "";
}

/// Width of a column of the systems' names.
std::size_t name_width(const Suite& suite, std::size_t least = 10) {
  for (const SystemSpec& system : suite.systems) least = std::max(least, system.name.size() + 1);
  return least;
}

/// "   2 of 3 trials, 1 failed" behind a row that lacks some; empty otherwise.
std::string lacking(const Suite& suite, const Row& row) {
  const auto all = static_cast<std::size_t>(suite.trials);
  if (row.trials.size() == all) return "";
  if (row.trials.empty())
    return all == 1 ? "   failed" : fmt::format("   failed: {} of {} trials", row.failed, all);
  return fmt::format("   {} of {}{}", row.trials.size(), counted(all, "trial"),
                     row.failed > 0 ? fmt::format(", {} failed", row.failed) : "");
}

/// The same of scenes: "   1 of 2 scenes, 3 runs failed".
std::string lacking(const CategoryRow& row) {
  std::string text;
  if (row.scenes < row.of) text = fmt::format("   {} of {}", row.scenes, counted(row.of, "scene"));
  if (row.failed > 0)
    text += fmt::format("{}{} failed", text.empty() ? "   " : ", ", counted(row.failed, "run"));
  return text;
}

/// What stands above all tables of tours that were cut.
std::string warning_of_cut(const Suite& suite, std::span<const RunResult> runs) {
  const auto cut = std::ranges::find_if(runs, [](const RunResult& run) { return run.place.cut; });
  if (cut == runs.end()) return "";
  return fmt::format(
      "\nSHORTENED to the first {} of each tour: a quick look, no result of this suite\n",
      counted(*suite.max_frames, "frame"));
}

/// Empty where nobody was asked anything, as in a suite of outside trajectories.
std::string table_2(const Block& block) {
  const auto asked = [&](QuerySet set) { return most_queries(block.rows, set) > 0; };
  if (block.suite.published != Published::kTable2 && std::ranges::none_of(kQuerySets, asked))
    return "";
  std::string text =
      fmt::format("  {:<44}{:>22}{:>22}\n", "", "Reloc. success (%)", "Average distance (m)");
  for (const QuerySet set : kQuerySets) {
    const double queries = most_queries(block.rows, set);
    if (queries == 0) continue;
    text +=
        fmt::format("  {}, {}\n", title(set), counted(std::lround(queries), "query", "queries"));
    for (const Row* row : block.rows) {
      const QuerySummary& s = summary(*row, set);
      const bool saturated = !block.system(row).sees_labels() && s.success > kSaturated;
      text += fmt::format(
          "    {:<{}}{:>22}{:>22}{}{}\n", block.system(row).name, name_width(block.suite, 42),
          s.queries > 0 ? fmt::format("{:.2f}", 100 * s.success) : "-", meters(s.distance_mean_m),
          saturated ? "   saturated" : "", lacking(block.suite, *row));
    }
  }
  if (block.suite.published != Published::kTable2) return text;
  text += "  published, other data (the paper's Table 2: a real house of 60 m2, YOLOv3 boxes)\n";
  text += fmt::format("    {:<42}{:>22}{:>22}\n", "the paper's semantic system", "79.25", "0.0512");
  text += fmt::format("    {:<42}{:>22}{:>22}\n", "ORB-SLAM2", "71.43", "0.0945");
  return text;
}

std::string query_details(const Block& block, QuerySet set) {
  const char* heading = set == QuerySet::kHeldOut ? "held-out" : "2nd tour";
  const std::size_t width = name_width(block.suite);
  std::string text =
      fmt::format("  {:<{}}{:>9}{:>10}{:>9}{:>10}{:>11}{:>12}{:>10}\n", heading, width, "success",
                  "correct", "false", "mean m", "median m", "aligned m", "attempts");
  for (const Row* row : block.detailed) {
    const QuerySummary& s = summary(*row, set);
    text += fmt::format(
        "  {:<{}}{:>9}{:>10}{:>9}{:>10}{:>11}{:>12}{:>10}\n", block.system(row).name, width,
        percent(s, &QuerySummary::success), percent(s, &QuerySummary::correct),
        percent(s, &QuerySummary::wrong), meters(s.distance_mean_m), meters(s.distance_median_m),
        meters(s.aligned_distance_mean_m), s.queries > 0 ? fmt::format("{:.2f}", s.attempts) : "-");
  }
  return text;
}

/// Keyframes left after the steps of Algorithm 1, as counts and as shares of the map; "-" is what a
/// program did not tell.
std::string candidate_details(const Block& block, QuerySet set) {
  const char* heading = set == QuerySet::kHeldOut ? "held-out" : "2nd tour";
  const std::size_t width = name_width(block.suite);
  std::string text = fmt::format("  {:<{}}{:>10}{:>18}{:>18}{:>18}{:>18}{:>11}{:>13}\n", heading,
                                 width, "keyframes", "after eq. 3", "after eq. 4", "after eq. 5",
                                 "after eq. 6", "one left", "label mass");
  for (const Row* row : block.detailed) {
    const QuerySummary& s = summary(*row, set);
    if (s.queries == 0) continue;
    const auto left = [&](const std::optional<double>& count) {
      if (!count) return std::string("-");
      if (!s.keyframes) return fmt::format("{:.2f}", *count);
      return fmt::format("{:.2f} ({:.2f}%)", *count, 100 * *count / std::max(1.0, *s.keyframes));
    };
    const auto share = [](const std::optional<double>& value) {
      return value ? fmt::format("{:.1f}%", 100 * *value) : std::string("-");
    };
    text += fmt::format(
        "  {:<{}}{:>10}{:>18}{:>18}{:>18}{:>18}{:>11}{:>13}\n", block.system(row).name, width,
        s.keyframes ? fmt::format("{:.0f}", *s.keyframes) : "-", left(s.c1), left(s.c2), left(s.c3),
        left(s.final), share(s.single_candidate), share(s.label_mass));
  }
  return text;
}

std::string failing_stages(const Block& block) {
  std::string text;
  for (const Row* row : block.detailed)
    for (const QuerySet set : kQuerySets) {
      std::map<RelocalizationStage, int> stages;
      for (const Trial& trial : row->trials)
        for (const QueryScore& q : queries(*trial.point, set))
          if (!q.success) ++stages[q.answer.stage];
      if (stages.empty()) continue;
      text += fmt::format("  {}, {}: unanswered, by the stage reached:", block.system(row).name,
                          name(set));
      const char* comma = "";
      for (const auto& [stage, count] : stages) {
        text += fmt::format("{} {} {}", comma, count,
                            reports_stage(block.system(row), stage) ? name(stage) : "not told");
        comma = ",";
      }
      text += "\n";
    }
  return text;
}

std::string mapping_details(const Block& block) {
  const std::size_t width = name_width(block.suite);
  std::string text =
      fmt::format("  {:<{}}{:>10}{:>14}{:>11}{:>12}{:>11}{:>10}{:>9}\n", "mapping", width, "ATE m",
                  "first pose m", "RPE m/fr", "RPE m/s", "complete", "restarts", "dropped");
  for (const Row* row : block.detailed) {
    const TrajectoryScore& t = row->trajectory;
    const auto cell = [&](const char* format, double value) {
      return row->trials.empty() ? "-" : fmt::format(fmt::runtime(format), value);
    };
    text += fmt::format(
        "  {:<{}}{:>10}{:>14}{:>11}{:>12}{:>11}{:>10}{:>9}{}\n", block.system(row).name, width,
        meters(t.ate_rmse_m), meters(t.ate_first_pose_m), meters(t.rpe_frame_rmse_m, 5),
        meters(t.rpe_second_rmse_m, 5), cell("{:.2f}%", 100 * t.completeness),
        cell("{:.0f}", row->restarts), cell("{:.0f}", row->dropped), lacking(block.suite, *row));
  }
  return text;
}

std::string penalties(const Block& block) {
  std::string text;
  for (const Row* row : block.rows) {
    if (!block.system(row).weighs_labels() || row->trials.empty()) continue;
    text += "  pairs penalized by xi (of those compared; rejected by it; ratio tests it helped)\n";
    for (std::size_t m = 0; m < row->matches.size(); ++m) {
      const MatcherCounts& c = row->matches[m];
      const double share = c.compared > 0 ? 100.0 * static_cast<double>(c.penalized) /
                                                static_cast<double>(c.compared)
                                          : 0.0;
      text +=
          fmt::format("    {:<26}{:>14}  ({:5.1f}% of {}; {}; {})\n", name(static_cast<Matcher>(m)),
                      c.penalized, share, c.compared, c.rejected_by_xi, c.ratio_helped);
    }
  }
  return text;
}

std::string common_ate(const Block& block) {
  std::string text;
  for (const auto& [first, second] : block.suite.compare) {
    const auto row_of = [&](std::size_t system) -> const Row* {
      const auto row = std::ranges::find_if(
          block.rows, [&](const Row* r) { return r->system == system && !r->trials.empty(); });
      return row == block.rows.end() ? nullptr : *row;
    };
    const Row *one = row_of(first), *other = row_of(second);
    if (one == nullptr || other == nullptr) continue;
    const auto [a, b] = ate_over_common_frames(*one, *other);
    text += fmt::format("  ATE over the frames that both tracked, m: {} {}, {} {}\n",
                        block.system(one).name, meters(a), block.system(other).name, meters(b));
  }
  return text;
}

/// "[-0.0123, +0.0456]"; "-" where too few pairs leave it open.
std::string interval(const Comparison& c) {
  return std::isfinite(c.low) && std::isfinite(c.high)
             ? fmt::format("[{:+.4f}, {:+.4f}]", c.low, c.high)
             : std::string("-");
}

/// The two systems of a family, by name.
struct PairNames {
  const std::string &first, &second;
  PairNames(const Suite& suite, const SystemPair& pair)
      : first(suite.systems[pair.first].name), second(suite.systems[pair.second].name) {}
};

std::string comparison_line(const PairNames& names, const Comparison& c) {
  if (c.pairs == 0) return fmt::format("  {:<62}-  (no pairs)\n", c.what);
  const Verdict v = verdict(c);
  const std::string word =
      v == Verdict::kFirstBetter    ? names.first + " is better"
      : v == Verdict::kSecondBetter ? names.second + " is better"
      : std::isfinite(c.detectable)
          ? fmt::format("undecided; smallest detectable difference {:.4f}", c.detectable)
          : std::string("undecided; too few pairs");
  const std::string corrected =
      c.in_family ? fmt::format("(Holm {:.4f})  {}", c.p_holm, word) : "(beside the family)";
  return fmt::format("  {:<62}{:+.4f} {}  p = {:.4f} {}\n", c.what, c.difference, interval(c), c.p,
                     corrected);
}

std::string block_text(const Block& block) {
  const Suite& suite = block.suite;
  const Row& row = *block.rows.front();
  std::string text = fmt::format(
      "\n{}, level {}, {}, {}{}{}\n",
      suite.environments.size() > 1 ? suite.environments[row.environment].name : suite.name,
      level_name(suite.levels[row.level]), with_labels(row.labels), counted(suite.trials, "trial"),
      suite.trials == 1 ? "" : " (medians)", shortened(suite, block.all));
  if (const std::string paper = table_2(block); !paper.empty()) text += rule(90) + paper + rule(90);
  for (const QuerySet set : kQuerySets)
    if (most_queries(block.rows, set) > 0)
      text += query_details(block, set) + candidate_details(block, set);
  text += failing_stages(block) + mapping_details(block);
  if (block.detailed.size() < block.rows.size())
    text +=
        "  plain: the same runs as above, since it looks at no labels; their details stand there\n";
  return text + common_ate(block) + penalties(block);
}

/// Of a comparison of success where the suite states a margin.
std::string margin_line(const Suite& suite, const PairNames& names, const Comparison& c) {
  if (!suite.non_inferiority_margin || c.pairs == 0 || !c.what.starts_with("success")) return "";
  const double margin = *suite.non_inferiority_margin;
  const std::string finding = fmt::format("{} is not worse", names.first);
  return fmt::format("  {:<62}{} by more than the {:.3f} stated beforehand\n", "",
                     not_inferior(c, margin) ? finding
                     : enough_for(c, margin) ? "not shown that " + finding
                                             : "too few pairs to show that " + finding,
                     margin);
}

std::string family_text(const Suite& suite, const Family& family) {
  const PairNames names(suite, family.systems);
  std::string text = fmt::format(
      "\n{} minus {}, level {}: blocks of queries resampled, 95 % intervals, Holm over {} of "
      "success "
      "and distance\n",
      names.first, names.second, level_name(suite.levels[family.level]),
      counted(family_size(family.comparisons), "comparison"));
  if (suite.trials == 1)
    text += "  one trial: this holds for these maps; other seeds draw other maps (--trials 10)\n";
  for (const Comparison& c : family.comparisons)
    text += comparison_line(names, c) + margin_line(suite, names, c);
  return text;
}

/// The plain system looks at no labels: its runs stand beside each kind, told of with the first.
bool told_above(const Suite& suite, const Row& row) {
  const auto first = std::ranges::find_if(suite.labels, [&](LabelMode labels) {
    return fits(suite.environments[row.environment], labels);
  });
  return !suite.systems[row.system].sees_labels() && row.labels != *first;
}

/// A suite of one place: everything about it.
std::string place_text(const Suite& suite, const std::vector<Row>& rows) {
  std::string text;
  for (auto first = rows.begin(); first != rows.end();) {
    Block block{suite, rows, {}, {}};
    auto end = first;
    for (; end != rows.end() && end->level == first->level && end->labels == first->labels; ++end) {
      block.rows.push_back(&*end);
      if (!told_above(suite, *end)) block.detailed.push_back(&*end);
    }
    text += block_text(block);
    first = end;
  }
  for (const Family& family : compare_systems(suite, rows)) text += family_text(suite, family);
  return text;
}

/// Width of a column of categories.
std::size_t category_width(const Suite& suite) {
  std::size_t width = 18;
  for (const Environment& e : suite.environments) width = std::max(width, e.category.size() + 1);
  return width;
}

std::string category_line(const Suite& suite, const CategoryRow& row,
                          const std::vector<CategoryRow>& all) {
  std::string text =
      fmt::format("  {:<{}}{:>7}  {:<{}}{:>9}{:>10}{:>11}", row.category, category_width(suite),
                  row.scenes, suite.systems[row.system].name, name_width(suite),
                  meters(row.ate_rmse_m), meters(row.rpe_frame_rmse_m, 5),
                  row.scenes > 0 ? fmt::format("{:.2f}%", 100 * row.completeness) : "-");
  for (const QuerySet set : kQuerySets) {
    const QuerySummary& s = summary(row, set);
    if (asked(all, set))
      text += fmt::format("{:>13}{:>11}{:>9}", percent(s, &QuerySummary::success),
                          percent(s, &QuerySummary::correct), meters(s.distance_mean_m));
  }
  const bool saturated =
      !suite.systems[row.system].sees_labels() && row.held_out.success > kSaturated;
  return text + (saturated ? "   saturated" : "") + lacking(row) + "\n";
}

std::string scene_family_text(const Suite& suite, const SceneFamily& family) {
  const PairNames names(suite, family.systems);
  std::string text = fmt::format(
      "\n{} minus {}, level {}: scenes resampled, 95 % intervals, Wilcoxon signed-rank, Holm over "
      "{} "
      "of success, distance and ATE\n",
      names.first, names.second, level_name(suite.levels[family.level]),
      counted(family_size(family.comparisons), "comparison"));
  const std::size_t scenes = suite.environments.size();
  for (const Comparison& c : family.comparisons) {
    if (c.pairs < scenes)
      text += fmt::format("  over {} of {}, where both have a value:\n", c.pairs,
                          counted(scenes, "scene"));
    text += comparison_line(names, c) + margin_line(suite, names, c);
  }
  return text;
}

/// A suite of many places, in the form of the paper's Table 1.
std::string scenes_text(const Suite& suite, const std::vector<Row>& rows) {
  std::string text;
  const CategoryRow* last = nullptr;
  const std::vector<CategoryRow> categories = make_category_rows(suite, rows);
  for (const CategoryRow& row : categories) {
    if (last == nullptr || last->level != row.level || last->labels != row.labels) {
      text += fmt::format(
          "\n{}, level {}, {}, {}{}; per scene the median over trials, then the mean "
          "over scenes\n",
          suite.name, level_name(suite.levels[row.level]), with_labels(row.labels),
          counted(suite.trials, "trial"), shortened(suite, rows));
      text += fmt::format("  {:<{}}{:>7}  {:<{}}{:>9}{:>10}{:>11}", "environments",
                          category_width(suite), "scenes", "system", name_width(suite), "ATE m",
                          "RPE m/fr", "complete");
      for (const QuerySet set : kQuerySets)
        if (asked(categories, set))
          text +=
              fmt::format("{:>13}{:>11}{:>9}", set == QuerySet::kHeldOut ? "held out" : "2nd tour",
                          "correct", "dist. m");
      text += "\n";
    }
    text += category_line(suite, row, categories);
    last = &row;
  }
  for (const SceneFamily& family : compare_over_scenes(suite, rows))
    text += scene_family_text(suite, family);
  return text;
}

/// "gamma 1, features.count 500"
std::string shown_point(const Sweep& sweep, const SlamConfig& point) {
  std::string text;
  for (const std::string& name : sweep.varied)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", shown_name(name),
                        shown_value(point, name));
  return text;
}

std::string best_points(const Suite& suite, const std::vector<Row>& rows) {
  std::string text =
      "\nmost correct answers, and the difference to the suite's own settings, or to the first "
      "point "
      "(chosen by the same queries: confirm it on others)\n";
  for (const SweepResult& result : sweep_results(suite, rows))
    for (const QuerySet set : kQuerySets) {
      const auto best = best_point(suite, rows, result, set);
      if (!best) continue;
      const SystemSpec& system = suite.systems[result.system];
      const SlamConfig at = settings_of(system, result.points[best->point]);
      const Comparison& c = best->to_reference;
      if (best->equals == result.points.size()) {
        text += fmt::format("  {}, level {}, {}, {}: {:.2f}% at each of {} points\n", system.name,
                            level_name(suite.levels[result.level]), with_labels(result.labels),
                            name(set), 100 * *summary(result.answers[best->point], set).correct,
                            best->equals);
        continue;
      }
      text += fmt::format(
          "  {}, level {}, {}, {}: {}: {:.2f}%, {}{}\n", system.name,
          level_name(suite.levels[result.level]), with_labels(result.labels), name(set),
          shown_point(suite.sweep, at), 100 * *summary(result.answers[best->point], set).correct,
          c.pairs == 0 ? std::string("-") : fmt::format("{:+.4f} {}", c.difference, interval(c)),
          best->equals > 1 ? fmt::format("; {} points are equal", best->equals) : "");
    }
  return text;
}

/// One line per parameter point and system, and the point that answers most.
std::string sweep_text(const Suite& suite, const std::vector<Row>& rows) {
  const std::vector<SlamConfig> points = parameter_points(suite);
  std::vector<int> widths;
  for (const std::string& varied : suite.sweep.varied)
    widths.push_back(std::max(9, static_cast<int>(shown_name(varied).size()) + 2));
  std::string text;
  const CategoryRow* last = nullptr;
  const std::vector<CategoryRow> categories = make_category_rows(suite, rows);
  for (const CategoryRow& row : categories) {
    if (row.category != kAllCategories) continue;
    if (last == nullptr || last->level != row.level || last->labels != row.labels) {
      text += fmt::format("\n{}, level {}, {}, map: {}, {}{}\n", suite.name,
                          level_name(suite.levels[row.level]), with_labels(row.labels),
                          name(suite.sweep.map), counted(suite.trials, "trial"),
                          shortened(suite, rows));
      text += fmt::format("  {:<{}}", "system", name_width(suite));
      for (std::size_t v = 0; v < widths.size(); ++v)
        text += fmt::format("{:>{}}", shown_name(suite.sweep.varied[v]), widths[v]);
      for (const QuerySet set : kQuerySets)
        if (asked(categories, set))
          text += fmt::format("{:>13}{:>11}{:>10}{:>9}{:>11}",
                              set == QuerySet::kHeldOut ? "held out" : "2nd tour", "correct",
                              "false", "dist. m", "candidates");
      text += "\n";
    }
    const SystemSpec& system = suite.systems[row.system];
    const SlamConfig seen = settings_of(system, points[row.parameters]);
    text += fmt::format("  {:<{}}", system.name, name_width(suite));
    for (std::size_t v = 0; v < widths.size(); ++v)
      text += fmt::format("{:>{}}",
                          system.is_program() ? "-" : shown_value(seen, suite.sweep.varied[v]),
                          widths[v]);
    for (const QuerySet set : kQuerySets) {
      const QuerySummary& s = summary(row, set);
      if (asked(categories, set))
        text +=
            fmt::format("{:>13}{:>11}{:>10}{:>9}{:>11}", percent(s, &QuerySummary::success),
                        percent(s, &QuerySummary::correct), percent(s, &QuerySummary::wrong),
                        meters(s.distance_mean_m), s.final ? fmt::format("{:.2f}", *s.final) : "-");
    }
    text += lacking(row) + "\n";
    last = &row;
  }
  return text + best_points(suite, rows);
}

/// Why runs are missing above.
std::string failures_text(std::span<const FailedRun> failed) {
  if (failed.empty()) return "";
  std::string text = fmt::format("\nfailed, so that the figures above are without {}:\n",
                                 counted(failed.size(), "run"));
  for (const FailedRun& run : failed) text += fmt::format("  {}: {}\n", run.spec.name, run.error);
  return text;
}

/// What is to be known of recordings: their one noise, and frames that no system was shown.
std::string recordings_text(const Suite& suite, std::span<const RunResult> runs) {
  if (std::ranges::none_of(suite.environments, &Environment::is_recorded)) return "";
  std::string text =
      "\nrecordings have one noise: trials and attempts differ in RANSAC's draws alone\n";
  std::set<std::string> told;
  for (const RunResult& run : runs) {
    const SkippedFrames& skipped = run.mapping.skipped;
    if (skipped.count == 0 || !told.insert(run.spec.environment.name).second) continue;
    text += fmt::format("  {}: {} skipped, the first: {}\n", run.spec.environment.name,
                        counted(skipped.count, "frame"), skipped.reasons.front());
  }
  return text;
}

/// Which runs of the suite nobody has made yet.
std::string missing_text(std::span<const std::string> missing) {
  if (missing.empty()) return "";
  constexpr std::size_t kMost = 10;
  std::string text = fmt::format("\nmissing, so that the figures above are without {}:\n",
                                 counted(missing.size(), "run"));
  for (std::size_t i = 0; i < std::min(kMost, missing.size()); ++i)
    text += fmt::format("  {}\n", missing[i]);
  if (missing.size() > kMost) text += fmt::format("  and {} more\n", missing.size() - kMost);
  return text;
}

/// Where the times come from: what other work did beside them shows in them.
std::string circumstances(std::span<const RunResult> runs) {
  std::set<std::string> hosts, sittings;
  bool unknown = false;
  Range jobs, load;
  for (const RunResult& run : runs) {
    const Circumstances& c = run.circumstances;
    hosts.insert(c.host);
    unknown = unknown || c.sitting.empty();
    if (c.sitting.empty()) continue;
    sittings.insert(c.host + " " + c.sitting);
    jobs.add(c.jobs);
    load.add(c.load);
  }
  std::string text = fmt::format("  measured on {}", fmt::join(hosts, ", "));
  if (!sittings.empty())
    text += fmt::format(" in {}, {} side by side, load per processor {}",
                        counted(sittings.size(), "sitting"),
                        jobs.text(0) + (jobs.most == 1 ? " job" : " jobs"), load.text(1));
  if (unknown)
    text += sittings.empty() ? ", it is not known when" : ", others it is not known when";
  if (hosts.size() > 1 || sittings.size() > 1 || unknown) text += ": rows need not compare";
  return text + "\n";
}

}  // namespace

std::string results_table(const Suite& suite, std::span<const RunResult> runs,
                          std::span<const FailedRun> failed, std::span<const std::string> missing) {
  const std::vector<Row> rows = make_rows(suite, runs, failed);
  return warning_of_cut(suite, runs) +
         (parameter_points(suite).size() > 1 ? sweep_text(suite, rows)
          : suite.environments.size() > 1    ? scenes_text(suite, rows)
                                             : place_text(suite, rows)) +
         recordings_text(suite, runs) + failures_text(failed) + missing_text(missing);
}

std::string times_table(const Suite& suite, std::span<const RunResult> runs) {
  const std::vector<Row> rows = make_rows(suite, runs);
  const auto label = [&](const Row& row) {
    const SystemSpec& system = suite.systems[row.system];
    std::string text = fmt::format("{}, {}", suite.environments[row.environment].name, system.name);
    if (system.sees_labels()) text += ", " + with_labels(row.labels);
    return text;
  };
  std::size_t width = 44;
  for (const Row& row : rows) width = std::max(width, label(row).size());
  std::string text = fmt::format("  {:<{}}{:>18}{:>18}\n", "wall time, ms per call: median (p95)",
                                 width, "track", "relocalize");
  for (const Row& row : rows) {
    if (suite.sweep.map == SweepMap::kFixed && row.parameters != 0) continue;  // the same calls
    if (told_above(suite, row)) continue;
    const auto cell = [](const TimeSummary& t) {
      if (t.p95_ms == 0) return std::string("-");  // no calls: its map was at hand
      return fmt::format("{:.1f} ({:.1f})", t.median_ms, t.p95_ms);
    };
    text += fmt::format("  {:<{}}{:>18}{:>18}\n", label(row), width, cell(row.track),
                        cell(row.relocalize));
  }
  return text + circumstances(runs);
}

}  // namespace mh
