// SPDX-License-Identifier: Apache-2.0
#include "bench/report/stress_report.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/report/export.hpp"
#include "bench/report/text_table.hpp"
#include "slam/io/counted.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

const StressCurve* curve_of(const StressResults& results, std::size_t dial, std::size_t system) {
  for (const StressCurve& curve : results.curves)
    if (curve.dial == dial && curve.system == system) return &curve;
  return nullptr;
}

/// The dose at a share of the range, as shown; not rounded to what a whole dial takes.
double shown_at(const StressDial& dial, double share) {
  return shown_dose(dial, exact_dose_at(dial, share));
}

std::string figure(double value) {
  return fmt::format("{:.3g}", std::abs(value) < 1e-12 ? 0.0 : value);
}

/// "2.1 (1.8 to 2.6)", "stands 8", "fails without it", "failed"
std::string cell(const StressDial& dial, const StressCurve* curve) {
  if (curve == nullptr) return "-";
  if (!curve->error.empty()) return "failed";
  const BreakingPoint& point = curve->point;
  if (point.breaks == Breaks::kBeforeAnyDose) return "fails without it";
  if (point.breaks == Breaks::kNever) return "stands " + figure(shown_at(dial, 1));
  const double low = shown_at(dial, point.low), high = shown_at(dial, point.high);
  return fmt::format("{} ({} to {})", figure(shown_at(dial, point.at)), figure(std::min(low, high)),
                     figure(std::max(low, high)));
}

/// Pairs of systems whose breaking points are compared: the suite's, otherwise each with the last.
std::vector<SystemPair> pairs_of(const Suite& suite) {
  if (!suite.compare.empty()) return suite.compare;
  std::vector<SystemPair> pairs;
  for (std::size_t s = 0; s + 1 < suite.systems.size(); ++s)
    pairs.push_back({s, suite.systems.size() - 1});
  return pairs;
}

std::optional<BreakingRatio> ratio_of(const Suite& suite, const StressResults& results,
                                      std::size_t dial, const SystemPair& pair) {
  const StressCurve *first = curve_of(results, dial, pair.first),
                    *second = curve_of(results, dial, pair.second);
  if (first == nullptr || second == nullptr || !first->error.empty() || !second->error.empty())
    return std::nullopt;
  const StressDial& of = suite.stress->dials[dial];
  const double factor = of.scale == DoseScale::kLog ? factor_of(of) : 0;
  return compare_breaking(doses_of(*first), doses_of(*second), suite.stress->bar, suite.seed,
                          factor);
}

std::string ratio_cell(const std::optional<BreakingRatio>& ratio) {
  return ratio ? fmt::format("{:.2f} ({:.2f} to {:.2f})", ratio->ratio, ratio->low, ratio->high)
               : "-";
}

std::vector<std::string> headings(const Suite& suite) {
  std::vector<std::string> names = {"fault", "unit", "usual"};
  for (const SystemSpec& system : suite.systems) names.push_back(system.name);
  for (const SystemPair& pair : pairs_of(suite))
    names.push_back(
        fmt::format("{} : {}", suite.systems[pair.first].name, suite.systems[pair.second].name));
  return names;
}

/// The cells of the dials that were reached.
std::vector<std::vector<std::string>> rows_of(const Suite& suite, const StressResults& results) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t d = 0; d < results.dials_reached; ++d) {
    const StressDial& dial = suite.stress->dials[d];
    std::vector<std::string> row = {dial.name, dial.unit,
                                    dial.usual ? figure(shown_dose(dial, *dial.usual)) : "-"};
    for (std::size_t s = 0; s < suite.systems.size(); ++s)
      row.push_back(cell(dial, curve_of(results, d, s)));
    for (const SystemPair& pair : pairs_of(suite))
      row.push_back(ratio_cell(ratio_of(suite, results, d, pair)));
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string title(const Suite& suite) {
  const bool correct = suite.stress->measure == StressMeasure::kCorrect;
  const std::string placed = fmt::format("frames placed within {:g} m", suite.stress->near_m);
  return fmt::format("{}: the dose at which {} fall to {:g} % of what they are without the fault",
                     suite.name, correct ? "correct answers" : placed.c_str(),
                     100 * suite.stress->bar);
}

/// What was not reached, and what failed.
std::string notes(const Suite& suite, const StressResults& results) {
  std::string text;
  const std::vector<StressDial>& dials = suite.stress->dials;
  if (results.dials_reached < dials.size()) {
    text += "  not reached within the budget:";
    for (std::size_t d = results.dials_reached; d < dials.size(); ++d)
      text += fmt::format("{} {}", d == results.dials_reached ? "" : ",", dials[d].name);
    text += "; the same command continues\n";
  }
  std::set<std::string> said;
  for (const StressCurve& curve : results.curves)
    if (!curve.error.empty() && said.insert(curve.error).second)
      text += curve.doses.empty()
                  ? fmt::format("  failed without any fault: {}\n", curve.error)
                  : fmt::format("  {} failed: {}\n", dials[curve.dial].name, curve.error);
  return text;
}

/// A breaking point relative to the usual dose: of the distances from no fault or, for factors, of
/// the factors.
double times_usual(const StressDial& dial, double at) {
  const double usual = share_of(dial, *dial.usual);
  return dial.scale == DoseScale::kLog ? std::pow(factor_of(dial), at - usual) : at / usual;
}

std::string in_html(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

}  // namespace

std::string stress_text(const Suite& suite, const StressResults& results) {
  TextTable table(headings(suite), 2);
  for (std::vector<std::string>& row : rows_of(suite, results)) table.add(std::move(row));
  return fmt::format(
      "{}\n{}{}  {}{}; level {}; seed {}; 95 % intervals over rooms; A : B is the ratio of their "
      "breaking points\n",
      title(suite), table.text(), notes(suite, results), counted(suite.environments.size(), "room"),
      suite.max_frames ? fmt::format(", first {}", counted(*suite.max_frames, "frame")) : "",
      level_name(suite.levels.front()), suite.seed);
}

std::string stress_latex(const Suite& suite, const StressResults& results) {
  const std::vector<std::string> names = headings(suite);
  std::string text =
      fmt::format("\\begin{{tabular}}{{ll{}}}\n\\hline\n", std::string(names.size() - 2, 'r'));
  const auto line = [&](const std::vector<std::string>& cells) {
    for (std::size_t c = 0; c < cells.size(); ++c) text += (c ? " & " : "") + latex_cell(cells[c]);
    text += " \\\\\n";
  };
  line(names);
  text += "\\hline\n";
  for (const auto& row : rows_of(suite, results)) line(row);
  return text + "\\hline\n\\end{tabular}\n";
}

Json stress_json(const Suite& suite, const StressResults& results) {
  Json dials = Json::array();
  for (std::size_t d = 0; d < results.dials_reached; ++d) {
    const StressDial& dial = suite.stress->dials[d];
    Json systems = Json::array(), ratios = Json::array();
    for (std::size_t s = 0; s < suite.systems.size(); ++s) {
      const StressCurve* curve = curve_of(results, d, s);
      if (curve == nullptr) continue;
      const BreakingPoint& point = curve->point;
      Json doses = Json::array();
      for (const StressedAt& at : curve->doses)
        doses.push_back({{"dose", at.dose},
                         {"shown", shown_dose(dial, at.dose)},
                         {"share", at.result.share()},
                         {"right", at.result.right},
                         {"asked", at.result.asked},
                         {"completeness", at.completeness},
                         {"ate_rmse_m", at.ate_rmse_m ? Json(*at.ate_rmse_m) : Json()}});
      const bool breaks = curve->error.empty() && point.breaks == Breaks::kAtDose;
      const double low = shown_at(dial, point.low), high = shown_at(dial, point.high);
      systems.push_back(
          {{"system", suite.systems[s].name},
           {"breaks", !curve->error.empty()             ? "failed"
                      : point.breaks == Breaks::kAtDose ? "at"
                      : point.breaks == Breaks::kNever  ? "never"
                                                        : "without"},
           {"error", curve->error.empty() ? Json() : Json(curve->error)},
           {"at", breaks ? Json(shown_at(dial, point.at)) : Json()},
           {"interval", breaks ? Json{std::min(low, high), std::max(low, high)} : Json()},
           {"times_usual", breaks && dial.usual && *dial.usual != dial.from
                               ? Json(times_usual(dial, point.at))
                               : Json()},
           {"doses", doses}});
    }
    for (const SystemPair& pair : pairs_of(suite))
      if (const auto ratio = ratio_of(suite, results, d, pair))
        ratios.push_back({{"first", suite.systems[pair.first].name},
                          {"second", suite.systems[pair.second].name},
                          {"ratio", ratio->ratio},
                          {"interval", {ratio->low, ratio->high}}});
    dials.push_back({{"dial", dial.dial},
                     {"name", dial.name},
                     {"unit", dial.unit},
                     {"from", shown_dose(dial, dial.from)},
                     {"to", shown_dose(dial, dial.to)},
                     {"usual", dial.usual ? Json(shown_dose(dial, *dial.usual)) : Json()},
                     {"source", dial.source},
                     {"systems", systems},
                     {"ratios", ratios}});
  }
  Json rooms = Json::array(), missing = Json::array();
  for (const Environment& environment : suite.environments) rooms.push_back(environment.name);
  for (std::size_t d = results.dials_reached; d < suite.stress->dials.size(); ++d)
    missing.push_back(suite.stress->dials[d].name);
  return {{"suite", suite.name},
          {"level", level_name(suite.levels.front())},
          {"seed", suite.seed},
          {"measure", name_of(suite.stress->measure, words(StressMeasure{}))},
          {"bar", suite.stress->bar},
          {"rooms", rooms},
          {"dials", dials},
          {"not_reached", missing}};
}

PlotPage stress_plots(const Suite& suite, const StressResults& results) {
  PlotPage page{.title = fmt::format("{}: what is left, over the dose of each fault", suite.name),
                .plots = {}};
  for (std::size_t d = 0; d < results.dials_reached; ++d) {
    const StressDial& dial = suite.stress->dials[d];
    const bool in_log = dial.scale == DoseScale::kLog;
    const auto x_of = [&](double dose) {
      const double shown = shown_dose(dial, dose);
      return in_log ? std::log10(shown) : shown;
    };
    Plot plot{.title = dial.name,
              .x_label = (in_log ? "log10: " : "") + dial.unit,
              .y_label = "share left",
              .series = {}};
    for (std::size_t s = 0; s < suite.systems.size(); ++s) {
      const StressCurve* curve = curve_of(results, d, s);
      Series line{.name = suite.systems[s].name, .dots = false, .points = {}},
          dots{.name = "", .dots = true, .points = {}};
      if (curve != nullptr && !curve->doses.empty())
        if (const double whole = curve->doses.front().result.share(); whole > 0) {
          std::vector<double> shares;
          for (const StressedAt& at : curve->doses) shares.push_back(at.result.share() / whole);
          const std::vector<double> smooth = never_rising(shares);
          for (std::size_t i = 0; i < shares.size(); ++i) {
            const double x = x_of(curve->doses[i].dose);
            line.points.push_back({x, smooth[i]});
            dots.points.push_back({x, shares[i]});
          }
        }
      plot.series.push_back(std::move(line));
      plot.series.push_back(std::move(dots));
    }
    const double first = x_of(dial.from), last = x_of(dial.to);
    plot.x_range = {std::min(first, last), std::max(first, last)};
    plot.y_range = {0, 1.2};
    page.plots.push_back(std::move(plot));
  }
  page.caption = fmt::format(
      "Dots: measured, all {} together; lines: never rising. A system breaks where its line falls "
      "below {:g}.",
      counted(suite.environments.size(), "room"), suite.stress->bar);
  return page;
}

std::string stress_html(const Suite& suite, const StressResults& results,
                        const std::string& image) {
  std::string rows;
  const auto line = [&](const std::vector<std::string>& cells, const char* tag) {
    rows += "<tr>";
    for (const std::string& text : cells) rows += fmt::format("<{0}>{1}</{0}>", tag, in_html(text));
    rows += "</tr>\n";
  };
  line(headings(suite), "th");
  for (const auto& row : rows_of(suite, results)) line(row, "td");
  std::string sources;
  for (const StressDial& dial : suite.stress->dials)
    if (dial.usual)
      sources += fmt::format("<li>{}: {} {}. {}</li>\n", in_html(dial.name),
                             figure(shown_dose(dial, *dial.usual)), in_html(dial.unit),
                             in_html(dial.source));
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<title>{0}: stress</title><style>\n"
      "body {{ font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 72rem; "
      "padding: 0 1rem; color-scheme: light dark; }}\n"
      "table {{ border-collapse: collapse; font-variant-numeric: tabular-nums; }}\n"
      "th, td {{ text-align: right; padding: .25rem .75rem; border-bottom: 1px solid #8884; }}\n"
      "th:nth-child(-n+2), td:nth-child(-n+2) {{ text-align: left; }}\n"
      "img {{ max-width: 100%; background: #fff; }} .wide {{ overflow-x: auto; }}\n"
      "</style></head><body>\n<h1>How much can it stand?</h1>\n<p>{1}, with 95 % intervals over "
      "{2}. \"stands\": not broken by the strongest dose. A : B: the ratio of their breaking "
      "points.</p>\n<div class=\"wide\"><table>\n{3}"
      "</table></div>\n<pre>{4}</pre>\n<img src=\"{5}\" alt=\"what is left over the dose of each "
      "fault\">\n<h2>What is usual</h2>\n<ul>\n{6}</ul>\n</body></html>\n",
      in_html(suite.name), in_html(title(suite)), counted(suite.environments.size(), "room"), rows,
      in_html(notes(suite, results)), in_html(image), sources);
}

std::string spread_text(const std::vector<Spread>& all) {
  if (all.empty()) return "";
  std::vector<std::string> names = {"environment", "system", "median"};
  for (const Spread::Change& change : all.front().changes) names.push_back(change.name);
  const bool known =
      std::ranges::any_of(all, [](const Spread& s) { return s.ate_rmse_m.has_value(); });
  if (known) names.emplace_back("true error");
  const auto cm = [](const std::optional<double>& m) {
    return m ? fmt::format("{:.2f}", 100 * *m) : "-";
  };
  TextTable table(names, 2);
  for (const Spread& spread : all) {
    std::vector<std::string> row = {spread.environment, spread.system, cm(spread.median_m)};
    for (const Spread::Change& change : spread.changes)
      row.push_back(change.both < 0.95 && change.rmse_m
                        ? fmt::format("{} ({:.0f} %)", cm(change.rmse_m), 100 * change.both)
                        : cm(change.rmse_m));
    if (known) row.push_back(cm(spread.ate_rmse_m));
    table.add(std::move(row));
  }
  std::string text =
      "how far the path moves if the input changes in a way that should not matter (RMSE, cm)\n" +
      table.text() +
      "  (n %): only n % of the frames have a pose in both\n"
      "  a large spread: at least some of these paths are wrong. A small one: no proof, since an\n"
      "  error that is the same each time, such as a wrong scale, does not show\n";
  if (const auto rank = rank_of_truth(all))
    text += fmt::format("  rank correlation with the true error over {}: {:.2f}\n",
                        counted(all.size(), "pair"), *rank);
  return text;
}

Json spread_json(const std::vector<Spread>& all) {
  const auto or_null = [](const std::optional<double>& value) {
    return value ? Json(*value) : Json();
  };
  Json list = Json::array();
  for (const Spread& spread : all) {
    Json changes = Json::array();
    for (const Spread::Change& change : spread.changes)
      changes.push_back({{"change", change.name},
                         {"rmse_m", or_null(change.rmse_m)},
                         {"share_of_frames", change.both}});
    list.push_back({{"environment", spread.environment},
                    {"system", spread.system},
                    {"median_m", or_null(spread.median_m)},
                    {"ate_rmse_m", or_null(spread.ate_rmse_m)},
                    {"changes", changes}});
  }
  return {{"spread", list}, {"rank_correlation", or_null(rank_of_truth(all))}};
}

}  // namespace mh
