// SPDX-License-Identifier: Apache-2.0
#include "bench/report/sweep_chart.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>

#include <fmt/format.h>

#include "slam/config/by_name.hpp"
#include "slam/config/slam.hpp"

namespace mh {
namespace {

struct Shades {
  const char *low, *high;
};
constexpr Shades kMoreIsBetter = {"#ecf3fb", "#084594"}, kLessIsBetter = {"#fdf3e7", "#a63603"};

/// A measure that a panel shows for each point.
struct PanelMeasure {
  std::string title;
  Shades shades;
  int digits;
  std::function<std::optional<double>(const QuerySummary&)> value;
};

std::optional<double> in_percent(const std::optional<double>& share) {
  return share ? std::optional(100 * *share) : std::nullopt;
}

std::vector<PanelMeasure> panel_measures() {
  return {
      {"correct answers, %", kMoreIsBetter, 1,
       [](const QuerySummary& s) { return in_percent(s.correct); }},
      {"false answers, %", kLessIsBetter, 1,
       [](const QuerySummary& s) { return in_percent(s.false_positive); }},
      {"mean distance, mm", kLessIsBetter, 1, [](const QuerySummary& s) -> std::optional<double> {
         if (!s.distance_mean_m) return std::nullopt;
         return 1e3 * *s.distance_mean_m;
       }}};
}

/// The values of a panel, with their minimum and maximum.
struct Values {
  std::vector<std::optional<double>> of;
  double least = 0, most = 0;

  Values(const SweepResult& result, QuerySet set, const PanelMeasure& measure) {
    for (const CategoryRow& row : result.answers) of.push_back(measure.value(summary(row, set)));
    bool any = false;
    for (const auto& value : of)
      if (value) {
        least = any ? std::min(least, *value) : *value;
        most = any ? std::max(most, *value) : *value;
        any = true;
      }
  }
};

/// The values that a setting takes in a sweep, with their text.
std::map<double, std::string> distinct(const SweepResult& result, std::string_view name) {
  std::map<double, std::string> values;
  for (const SlamConfig& point : result.points)
    values.emplace(setting_value(point, name), shown_value(point, name));
  return values;
}

/// The weight of labels at each value of a setting, as text to be shown below the value: the
/// measured label mass or, if the mass itself is varied, the gamma that resulted in it. Empty for a
/// setting that does not affect the weight of labels.
std::map<double, std::string> weights_of_labels(const SweepResult& result, std::string_view name) {
  if (!weighs_labels(name)) return {};
  std::map<double, std::vector<double>> masses, gammas;
  for (std::size_t i = 0; i < result.points.size(); ++i)
    for (const QuerySet set : kQuerySets) {
      const QuerySummary& s = summary(result.answers[i], set);
      const double value = setting_value(result.points[i], name);
      if (s.label_mass) masses[value].push_back(*s.label_mass);
      if (s.gamma) gammas[value].push_back(*s.gamma);
    }
  std::map<double, std::string> texts;
  for (const auto& [value, measured] : masses)
    texts[value] = name == kGamma ? fmt::format("({:.1f} %)", 100 * mean(measured))
                                  : fmt::format("(gamma {:.3g})", mean(gammas[value]));
  return texts;
}

struct Panel {
  const SweepResult& result;
  std::string across, up;  ///< the settings along the axes; up is empty if only one is varied
  std::string title;
  const PanelMeasure& measure;
  const Values& values;
  std::optional<std::size_t> framed;  ///< the highlighted point
};

/// The values of a setting as text on an axis, with the weight of labels below each.
ShadedField::Ticks ticks(const SweepResult& result, const std::string& name, bool cells) {
  if (name.empty()) return {};
  const auto below = weights_of_labels(result, name);
  ShadedField::Ticks list;
  const auto values = distinct(result, name);
  for (const auto& [value, text] : values) {
    const auto more = below.find(value);
    // Dots are placed by value, so only the lowest and the highest value are written on the axis.
    if (!cells && value != values.begin()->first && value != values.rbegin()->first) continue;
    list.emplace_back(cells ? static_cast<double>(list.size()) : value,
                      more == below.end() ? text : text + "\n" + more->second);
  }
  return list;
}

/// One panel: a grid with a cell per point, or a plane over two settings with a dot per point.
Plot panel_plot(const Panel& panel, bool cells) {
  const auto& [result, across, up, title, measure, values, framed] = panel;
  ShadedField field{.cells = cells,
                    .marks = {},
                    .x_ticks = ticks(result, across, cells),
                    .y_ticks = ticks(result, up, cells),
                    .low_color = measure.shades.low,
                    .high_color = measure.shades.high};
  const auto at = [&](const SlamConfig& point, const std::string& name) {
    if (name.empty()) return 0.0;
    const double value = setting_value(point, name);
    if (!cells) return value;
    const auto all = distinct(result, name);
    return static_cast<double>(std::distance(all.begin(), all.find(value)));
  };
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    if (!values.of[i]) continue;
    if (framed == i) field.framed = field.marks.size();
    field.marks.push_back({at(result.points[i], across), at(result.points[i], up), *values.of[i],
                           cells ? fmt::format("{:.{}f}", *values.of[i], measure.digits) : ""});
  }
  return {title,
          std::string(shown_name(across)),
          up.empty() ? "" : std::string(shown_name(up)),
          {},
          std::move(field)};
}

bool is_grid(const SweepResult& result, const std::vector<std::string>& varied) {
  std::size_t cells = 1;
  for (const std::string& name : varied) cells *= distinct(result, name).size();
  return varied.size() <= 2 && cells == result.points.size();
}

std::string place_of(const SlamConfig& point, const std::vector<std::string>& varied) {
  std::string text;
  for (const std::string& name : varied)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", shown_name(name),
                        shown_value(point, name));
  return text;
}

std::string caption(const SweepResult& result, QuerySet set, const std::vector<std::string>& varied,
                    const BestPoint& best) {
  const Comparison& c = best.to_reference;
  if (best.equals == result.points.size())
    return fmt::format("{}: {:.1f} % correct at each of {} points", name(set),
                       100 * *summary(result.answers[best.point], set).correct, best.equals);
  return fmt::format(
      "{}: most correct answers at {}{}: {:.1f} %, {:+.1f} [{:+.1f}, {:+.1f}] points against {}",
      name(set), place_of(result.points[best.point], varied),
      best.equals > 1 ? fmt::format(" (one of {} equals)", best.equals) : "",
      100 * *summary(result.answers[best.point], set).correct, 100 * c.difference, 100 * c.low,
      100 * c.high, place_of(result.points[best.reference], varied));
}

}  // namespace

std::string sweep_image_name(const SystemSpec& system, const Labels& labels, const Level& level) {
  return fmt::format("sweep-{}-{}-{}.png", system.name, name(labels), level_name(level));
}

PlotPage sweep_chart(const Suite& suite, std::span<const Row> rows, const SweepResult& result) {
  const std::vector<std::string>& varied = suite.sweep.varied;
  const bool grid = is_grid(result, varied);
  std::vector<std::pair<std::string, std::string>> pairs;  // settings (across, up) of each panel
  for (std::size_t i = 0; i < varied.size(); ++i)
    for (std::size_t j = i + 1; j < varied.size(); ++j) pairs.emplace_back(varied[j], varied[i]);
  const std::vector<PanelMeasure> all = panel_measures();
  PlotPage page{fmt::format("{}: {}, {}, level {}, map: {}", suite.name,
                            suite.systems[result.system].name, with_labels(result.labels),
                            level_name(suite.levels[result.level]), name(suite.sweep.map)),
                {}};
  for (const QuerySet set : kQuerySets) {
    const auto best = best_point(suite, rows, result, set);
    if (!best) continue;
    for (std::size_t i = 0; i < (grid ? all.size() : pairs.size()); ++i) {
      const PanelMeasure& measure = grid ? all[i] : all.front();
      const Values values(result, set, measure);
      Panel panel{result, grid ? varied.back() : pairs[i].first, "", "", measure, values, {}};
      if (!grid || varied.size() > 1) panel.up = grid ? varied.front() : pairs[i].second;
      panel.title = grid ? fmt::format("{}: {}", name(set), measure.title)
                         : fmt::format("{}: {:.1f} to {:.1f} % correct", name(set), values.least,
                                       values.most);
      if ((!grid || i == 0) && best->equals < result.points.size()) panel.framed = best->point;
      page.plots.push_back(panel_plot(panel, grid));
    }
    page.caption += caption(result, set, varied, *best) + "\n";
  }
  page.caption +=
      "framed: most correct answers, chosen by these same queries: confirm it on others";
  return page;
}

}  // namespace mh
