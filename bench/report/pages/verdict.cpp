// SPDX-License-Identifier: Apache-2.0
#include "bench/report/pages/verdict.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "bench/report/pages/headlines.hpp"
#include "bench/report/pages/page_table.hpp"
#include "bench/report/wording.hpp"
#include "slam/io/counted.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

bool is_share(const Comparison& c) {
  return c.what.unit.empty();
}

/// A value in the unit in which it is shown: percentage points or mm.
double shown(const Comparison& c, double value) {
  return (is_share(c) ? 100 : 1000) * value;
}

/// A signed amount with its unit: "+4.20 percentage points", "-3.10 mm".
std::string amount(const Comparison& c, double value, bool with_unit = true) {
  const double scaled = shown(c, value);
  const char* unit = !with_unit ? "" : is_share(c) ? " percentage points" : " mm";
  // A value other than zero must not be shown as zero.
  if (scaled != 0 && std::abs(scaled) < 0.005) return fmt::format("{:+.1g}{}", scaled, unit);
  return fmt::format("{:+.2f}{}", scaled, unit);
}

/// The number of pairs and what they are: "149 queries", "12 environments".
std::string pairs_text(const Comparison& c, bool over_scenes) {
  if (c.clusters > 0)
    return fmt::format("{} in {}", counted(c.pairs, "query", "queries"),
                       counted(c.clusters, "environment"));
  return over_scenes ? counted(c.pairs, "environment") : counted(c.pairs, "query", "queries");
}

/// "about 812 environments"
std::string needed_pairs(const Comparison& c, double needed, bool over_scenes) {
  constexpr double kMost = 10'000;
  return fmt::format(
      "{} {}",
      needed > kMost ? fmt::format("more than {:.0f}", kMost) : fmt::format("about {:.0f}", needed),
      over_scenes || c.clusters > 0 ? "environments" : "queries");
}

std::string needed_text(const Comparison& c, bool over_scenes) {
  const auto needed = pairs_to_decide(c);
  if (!std::isfinite(c.detectable))
    return " These are too few to decide at the 5 % level, however large the difference.";
  if (!needed) return "";
  return fmt::format(" If the true difference is the observed one, {} would decide.",
                     needed_pairs(c, *needed, over_scenes));
}

/// Whether both systems do so well that no difference could be detected.
bool both_answer_all(std::span<const Row> rows, const Judged& j, const Suite& suite) {
  if (j.comparison.what.measure != name(suite.measure)) return false;
  const auto share = [&](std::size_t system) {
    std::vector<double> shares;
    for (const Row& row : rows)
      for (const QuerySet set : kQuerySets)
        if (row.system == system && row.level == j.level && row.parameters == 0 &&
            name(set) == j.comparison.what.of &&
            with_labels(row.labels) == j.comparison.what.labels && !row.trials.empty() &&
            (j.environment.empty() || suite.environments[row.environment].name == j.environment) &&
            summary(row, set).queries > 0)
          shares.push_back(suite.measure == Measure::kSuccess
                               ? summary(row, set).success
                               : summary(row, set).correct.value_or(0));
    return mean(shares);
  };
  return share(j.systems.first) > kSaturated && share(j.systems.second) > kSaturated;
}

/// What is compared, as text. The kind of labels is left out if neither system sees labels. The
/// unit is left out because the amount already has it.
std::string compared(const Suite& suite, const SystemPair& systems, const Comparison& c) {
  Compared what = c.what;
  what.unit.clear();
  if (!suite.systems[systems.first].sees_labels() && !suite.systems[systems.second].sees_labels())
    what.labels.clear();
  return what.text();
}

}  // namespace

std::vector<Judged> judged(const Suite& suite, std::span<const Row> rows) {
  std::vector<Judged> all;
  if (suite.environments.size() > 1) {
    for (const SceneFamily& family : compare_over_scenes(suite, rows)) {
      if (family.parameters != 0) continue;
      for (const Comparison& c : family.comparisons)
        all.push_back({family.systems, family.level, "", c});
    }
  } else {
    for (const Family& family : compare_systems(suite, rows))
      for (const Comparison& c : family.comparisons)
        all.push_back(
            {family.systems, family.level, suite.environments[family.environment].name, c});
  }
  for (Judged& j : all) j.saturated = both_answer_all(rows, j, suite);
  // The family comes first, led by the suite's measure; then the comparisons that are shown
  // alongside; and last those without pairs.
  std::ranges::stable_sort(all, {}, [&](const Judged& j) {
    const Comparison& c = j.comparison;
    return std::array{c.pairs == 0, !c.in_family, c.what.measure != name(suite.measure)};
  });
  return all;
}

std::optional<double> pairs_to_decide(const Comparison& c) {
  const double size = static_cast<double>(c.clusters > 0 ? c.clusters : c.pairs);
  if (c.pairs == 0 || c.difference == 0 || !std::isfinite(c.detectable) || c.detectable <= 0)
    return std::nullopt;
  const double ratio = c.detectable / std::abs(c.difference);
  return std::ceil(size * ratio * ratio);
}

std::string finding(const Suite& suite, const Judged& j) {
  const Comparison& c = j.comparison;
  std::string what = compared(suite, j.systems, c);
  std::ranges::replace(what, '_', ' ');
  what.front() = static_cast<char>(std::toupper(what.front()));
  if (c.pairs == 0) return what + ": nothing that both have a value for.";
  const bool over_scenes = j.environment.empty();
  const std::string interval =
      std::isfinite(c.low) && std::isfinite(c.high)
          ? fmt::format("95 % interval {} to {}", amount(c, c.low, false), amount(c, c.high, false))
          : std::string("too few for an interval");
  return fmt::format("{}: {} ({}) over {}.{}", what, amount(c, c.difference), interval,
                     pairs_text(c, over_scenes),
                     verdict(c) != Verdict::kUndecided ? ""
                     : j.saturated ? " Saturated: both do so well that no difference can show."
                                   : needed_text(c, over_scenes));
}

Json verdicts_json(const Suite& suite, std::span<const Row> rows) {
  PageTable table(
      "What differs between the systems",
      "First minus second, 95 % bootstrap intervals, p corrected by Holm over the "
      "declared family; shares in percentage points, distances in mm. p of pooled rows is "
      "of random signs, so that it has a least value.");
  Json differences = Json::array();
  const std::vector<Judged> all = judged(suite, rows);
  for (const Judged& j : all) {
    const Comparison& c = j.comparison;
    const auto known = [&](double value) {
      return c.pairs > 0 ? std::optional(value) : std::nullopt;
    };
    const std::string& first = suite.systems[j.systems.first].name;
    const std::string& second = suite.systems[j.systems.second].name;
    const std::string& level = level_name(suite.levels[j.level]);
    const Verdict v = verdict(c);
    differences.push_back({{"finding", finding(suite, j)},
                           {"decided", v != Verdict::kUndecided},
                           {"in_family", c.in_family},
                           {"pooled", c.clusters > 0},
                           {"measure", c.what.measure},
                           {"what", compared(suite, j.systems, c)},
                           {"level", level},
                           {"unit", is_share(c) ? "%" : "m"},
                           {"first", first},
                           {"second", second},
                           {"difference", page_number(known(c.difference))},
                           {"low", page_number(known(c.low))},
                           {"high", page_number(known(c.high))}});
    table.begin_row();
    table.text({"what", "compared"}, compared(suite, j.systems, c));
    table.text({"level", "level"}, level);
    table.text({"first", "first"}, first);
    table.text({"second", "second"}, second);
    const bool over_scenes = j.environment.empty();
    const auto scaled = [&](double value) { return known(shown(c, value)); };
    table.text({"over", "over"}, c.pairs > 0 ? pairs_text(c, over_scenes) : "");
    table.text({"unit", "unit"}, is_share(c) ? "points" : "mm");
    table.number({"difference", "difference", "", 2}, scaled(c.difference));
    table.number({"low", "low", "", 2}, scaled(c.low));
    table.number({"high", "high", "", 2}, scaled(c.high));
    table.number({"p", "p", "", 5}, known(c.p));
    table.number({"p_holm", "p (Holm)", "", 5}, counts(c) ? std::optional(c.p_holm) : std::nullopt);
    table.number({"detectable", "detectable", "", 2}, scaled(c.detectable));
    const auto needed = pairs_to_decide(c);
    table.text({"needed", "would decide"}, needed ? needed_pairs(c, *needed, over_scenes) : "");
    table.text({"verdict", "verdict"}, !c.in_family                 ? "beside the family"
                                       : v == Verdict::kUndecided   ? "no difference shown"
                                       : v == Verdict::kFirstBetter ? first + " is better"
                                                                    : second + " is better");
  }
  return {{"headlines", headlines_json(suite, rows, all)},
          {"differences", differences},
          {"table", table.json()}};
}

}  // namespace mh
