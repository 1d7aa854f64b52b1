// SPDX-License-Identifier: Apache-2.0
#include "bench/report/pages/headlines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/report/pages/page_table.hpp"
#include "bench/report/pages/tables.hpp"
#include "bench/report/wording.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;
using Found = std::vector<const Judged*>;

/// A length in a readable unit: "3.1 mm", "2.57 m".
std::string length_text(double m) {
  if (m >= 1) return fmt::format("{:.2f} m", m);
  return m < 5e-5 ? fmt::format("{:.1g} mm", 1e3 * m) : fmt::format("{:.1f} mm", 1e3 * m);
}

std::string set_text(const std::string& of) {
  return of == name(QuerySet::kHeldOut)      ? " held out"
         : of == name(QuerySet::kSecondTour) ? " on the second tour"
                                             : " to graded queries";
}

/// By how much the better system is better, as "12.4 points more correct answers on the second
/// tour".
std::string gain_text(const Suite& suite, const Comparison& c) {
  const double size = std::abs(c.difference);
  const std::string labels =
      suite.labels.size() > 1 && !c.what.labels.empty() ? ", " + c.what.labels : "";
  if (c.what.of.empty()) return fmt::format("an ATE {} smaller{}", length_text(size), labels);
  if (!c.what.unit.empty())
    return fmt::format("answers {} closer{}{}", length_text(size), set_text(c.what.of), labels);
  return fmt::format("{:.{}f} points more {}{}{}", 100 * size, size < 5e-4 ? 3 : 1,
                     suite.measure == Measure::kCorrect ? "correct answers" : "answers",
                     set_text(c.what.of), labels);
}

std::string gains_text(const Suite& suite, const Found& gains) {
  constexpr std::size_t kMost = 3;
  std::vector<std::string> parts;
  for (const Judged* j : gains)
    if (parts.size() < kMost) parts.push_back(gain_text(suite, j->comparison));
  if (gains.size() > kMost) parts.push_back(fmt::format("{} more below", gains.size() - kMost));
  return fmt::format("{}", fmt::join(parts, "; "));
}

/// Whether a pair differs in nothing but the use of labels.
bool is_of_labels(const SystemSpec& first, const SystemSpec& second) {
  return first.kind == SystemKind::kSemantic && second.kind == SystemKind::kPlain &&
         first.settings.empty() && second.settings.empty();
}

/// A sentence about ATE for a suite of a single environment, where ATE has no p: " The ATE of slow
/// is 5.2 times that of plain: ...". Empty if there is nothing to mention.
std::string ate_text(const Suite& suite, std::span<const Row> rows, const SystemPair& pair,
                     std::size_t level) {
  if (suite.environments.size() > 1) return "";
  const auto row_of = [&](std::size_t system, const Row* like) {
    const auto found = std::ranges::find_if(rows, [&](const Row& row) {
      return row.system == system && row.level == level && row.parameters == 0 &&
             !row.trials.empty() && (like == nullptr || row.labels == like->labels);
    });
    return found == rows.end() ? nullptr : &*found;
  };
  const Row* first = row_of(pair.first, nullptr);
  const Row* second = first == nullptr ? nullptr : row_of(pair.second, first);
  if (second == nullptr) return "";
  const auto [a, b] = ate_over_common_frames(*first, *second);
  if (!a || !b || std::max(*a, *b) < kToldFactor * std::min(*a, *b)) return "";
  const bool first_is_worse = *a > *b;
  const std::string& worse = suite.systems[first_is_worse ? pair.first : pair.second].name;
  const std::string& better = suite.systems[first_is_worse ? pair.second : pair.first].name;
  const double high = std::max(*a, *b), low = std::min(*a, *b);
  return fmt::format(" The ATE of {} is {} that of {}: {}, {}.", worse,
                     low > 0 ? fmt::format("{:.1f} times", high / low) : std::string("far above"),
                     better, length_text(high), length_text(low));
}

std::string undecided_text(const Suite& suite, const std::string& pair, bool of_labels,
                           const Found& family) {
  const std::string who = of_labels ? "Labels" : pair,
                    between = of_labels ? " between " + pair : "";
  if (family.empty())
    return fmt::format("{}: no query was asked that both can be judged by.", pair);
  const auto all_of = [&](auto holds) { return std::ranges::all_of(family, holds); };
  if (all_of([](const Judged* j) { return !std::isfinite(j->comparison.detectable); }))
    return fmt::format("{}: too few {} to show a difference.", who,
                       suite.environments.size() > 1 ? "environments" : "queries");
  const auto by_measure = [&](const Judged* j) {
    return j->comparison.what.measure == name(suite.measure);
  };
  if (std::ranges::any_of(family, by_measure) &&
      all_of([&](const Judged* j) { return j->saturated || !by_measure(j); }))
    return fmt::format("{}: no difference can show{}: both answer nearly everything{}.", who,
                       between, suite.measure == Measure::kCorrect ? " correctly" : "");
  return fmt::format("{}: no difference shown{}.", who, between);
}

Json headline(const Suite& suite, std::span<const Row> rows, const SystemPair& systems,
              std::size_t level, const Found& family) {
  const SystemSpec &first = suite.systems[systems.first], &second = suite.systems[systems.second];
  const std::string pair = fmt::format("{} and {}", first.name, second.name);
  Found for_first, for_second;
  for (const Judged* j : family) {
    const Verdict v = verdict(j->comparison);
    if (v == Verdict::kFirstBetter) for_first.push_back(j);
    if (v == Verdict::kSecondBetter) for_second.push_back(j);
  }
  const bool decided = !for_first.empty() || !for_second.empty();
  // The system that is better by the suite's measure leads. If neither or both are better by it,
  // the first system leads, provided that it is better in anything.
  const auto by_measure = [&](const Found& gains) {
    return std::ranges::any_of(
        gains, [&](const Judged* j) { return j->comparison.what.measure == name(suite.measure); });
  };
  const bool second_leads =
      by_measure(for_second) != by_measure(for_first) ? by_measure(for_second) : for_first.empty();
  const Found &lead = second_leads ? for_second : for_first,
              &other = second_leads ? for_first : for_second;
  const std::string &leader = (second_leads ? second : first).name,
                    &follower = (second_leads ? first : second).name;
  std::string text;
  if (!decided)
    text = undecided_text(suite, pair, is_of_labels(first, second), family);
  else if (other.empty() || by_measure(for_first) != by_measure(for_second))
    text = fmt::format("{} is better than {}: {}", leader, follower, gains_text(suite, lead));
  else
    text = fmt::format("{} has {}", leader, gains_text(suite, lead));
  if (!other.empty()) text += fmt::format("; {} has {}", follower, gains_text(suite, other));
  if (decided) text += ".";
  const Judged* shown = decided ? lead.front() : nullptr;
  // If nothing is decided, the largest difference is shown, preferably one by the suite's measure
  // that is not saturated.
  if (shown == nullptr && !family.empty()) {
    const auto told = [&](const Judged* j) {
      return std::tuple(j->comparison.what.measure == name(suite.measure), !j->saturated,
                        std::abs(j->comparison.difference));
    };
    shown = *std::ranges::max_element(family, {}, told);
  }
  return {{"level", level_name(suite.levels[level])},
          {"first", first.name},
          {"second", second.name},
          {"text", text + ate_text(suite, rows, systems, level)},
          {"detail", shown == nullptr ? "" : finding(suite, *shown)},
          {"decided", decided}};
}

}  // namespace

Json headlines_json(const Suite& suite, std::span<const Row> rows, std::span<const Judged> all) {
  Json headlines = Json::array();
  for (std::size_t level = 0; level < suite.levels.size(); ++level)
    for (const SystemPair& pair : suite.compare) {
      const auto has_rows = [&](std::size_t system) {
        return std::ranges::any_of(rows, [&](const Row& row) {
          return row.system == system && row.level == level && !row.trials.empty();
        });
      };
      if (!has_rows(pair.first) || !has_rows(pair.second)) continue;
      Found family;
      for (const Judged& j : all)
        if (j.systems == pair && j.level == level && counts(j.comparison)) family.push_back(&j);
      headlines.push_back(headline(suite, rows, pair, level, family));
    }
  return headlines;
}

Json tiles_json(const Suite& suite, std::span<const Row> rows,
                std::span<const CategoryRow> categories) {
  PageTable table("Systems",
                  "Over all environments: medians over trials, then means. Milliseconds are the "
                  "median time of a mapped frame.");
  for (const CategoryRow& c : categories) {
    if (c.category != kAllCategories || c.parameters != 0 || c.scenes == 0 ||
        !is_own_row(suite, c.system, c.labels))
      continue;
    table.begin_row();
    table.text({"system", "system"}, suite.systems[c.system].name);
    table.text({"labels", "labels"}, labels_seen(suite, c.system, c.labels));
    table.text({"level", "level"}, level_name(suite.levels[c.level]));
    table.number({"completeness", "mapped", "%", 1}, c.trajectory.completeness);
    table.number({"ate_rmse_m", "ATE", "m", 4}, c.trajectory.ate_rmse_m);
    for (const QuerySet set : kQuerySets) {
      const QuerySummary& s = summary(c, set);
      if (s.queries == 0) continue;
      const std::string key = fmt::format("{}.", name(set));
      const char* of = set == QuerySet::kHeldOut      ? " held out"
                       : set == QuerySet::kSecondTour ? " on revisit"
                                                      : ", graded";
      table.number({key + "correct", std::string("correct") + of, "%", 1}, s.correct);
      table.number({key + "success", std::string("answered") + of, "%", 1}, s.success);
    }
    std::vector<double> track_ms;
    for (const Row& row : rows)
      if (row.system == c.system && row.level == c.level && row.parameters == 0 &&
          row.labels == c.labels && row.track.median_ms > 0)
        track_ms.push_back(row.track.median_ms);
    table.number({"track_ms", "time per frame", "ms", 1},
                 track_ms.empty() ? std::nullopt : std::optional(median(track_ms)));
    table.text({"remark", "remark"}, incomplete(c));
  }
  return table.json();
}

}  // namespace mh
