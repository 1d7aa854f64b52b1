// SPDX-License-Identifier: Apache-2.0
#include "bench/report/graded_report.hpp"

#include <fmt/format.h>

#include "bench/report/comparisons_text.hpp"
#include "bench/report/text_table.hpp"
#include "bench/suite/json_fields.hpp"
#include "slam/io/counted.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

/// "0.4 to 0.8"; for a speed, its value.
std::string bin_name(const GradedCurve& curve, const GradedBin& bin) {
  if (curve.by == "speed") return fmt::format("{:.3g}", 0.5 * (bin.low + bin.high));
  return fmt::format("{:.3g} to {:.3g}", bin.low, bin.high);
}

std::string title(const GradedCurve& curve) {
  return fmt::format("{}{}{}", curve.by, curve.unit.empty() ? "" : ", " + curve.unit,
                     curve.category == kAllCategories ? "" : ": " + curve.category);
}

std::string curve_text(const Suite& suite, const GradedCurve& curve) {
  std::vector<std::string> headings{title(curve), "queries"};
  for (const SystemSpec& system : suite.systems) {
    headings.push_back(system.name + " success");
    headings.insert(headings.end(), {"correct", "false pos."});
  }
  if (!suite.compare.empty())
    headings.push_back(fmt::format("{} minus {}", suite.systems[suite.compare.front().first].name,
                                   suite.systems[suite.compare.front().second].name));
  TextTable table(std::move(headings));
  for (const GradedBin& bin : curve.bins) {
    std::vector<std::string> cells{bin_name(curve, bin), std::to_string(bin.queries)};
    for (const auto& share : bin.systems)
      for (const double GradedShare::*value :
           {&GradedShare::success, &GradedShare::correct, &GradedShare::false_positive})
        cells.push_back(share ? fmt::format("{:.1f}%", 100 * (*share).*value) : "-");
    if (!suite.compare.empty())
      cells.push_back(bin.difference ? fmt::format("{:+.4f} {}", bin.difference->difference,
                                                   interval(*bin.difference))
                                     : "-");
    table.add(std::move(cells));
  }
  return table.text();
}

std::string draws_text(const Suite& suite, std::span<const Row> rows) {
  const GradedDraws draws = graded_draws(suite, rows);
  std::string text = fmt::format(
      "  not asked, since mapped frames show less than {:g} % of what they see: {} of {} views\n",
      100 * suite.graded->least_shown, draws.hidden, draws.asked + draws.hidden);
  if (draws.short_cells > 0)
    text += fmt::format("  {} of {} pairs of bins hold fewer than {}: there are no such views\n",
                        draws.short_cells, draws.cells,
                        counted(suite.graded->per_bin, "query", "queries"));
  return text;
}

}  // namespace

std::string graded_table(const Suite& suite, std::span<const Row> rows) {
  const std::vector<GradedCurve> curves = graded_curves(suite, rows);
  std::string text;
  const GradedCurve* before = nullptr;
  for (const GradedCurve& curve : curves) {
    if (before == nullptr || before->level != curve.level || before->labels != curve.labels)
      text += fmt::format(
          "\ngraded queries, level {}, {}: by the nearest mapped view (m + rad), 95 % intervals\n",
          level_name(suite.levels[curve.level]), with_labels(curve.labels));
    text += curve_text(suite, curve);
    before = &curve;
  }
  return text.empty() ? text : text + draws_text(suite, rows);
}

Json graded_json(const Suite& suite, std::span<const Row> rows) {
  Json list = Json::array();
  for (const GradedCurve& curve : graded_curves(suite, rows)) {
    Json bins = Json::array();
    for (const GradedBin& bin : curve.bins) {
      Json systems = Json::object();
      for (std::size_t s = 0; s < bin.systems.size(); ++s)
        if (const auto& share = bin.systems[s])
          systems[suite.systems[s].name] = {{"success", share->success},
                                            {"correct", share->correct},
                                            {"false_positive", share->false_positive},
                                            {"low", share->low},
                                            {"high", share->high}};
      Json one = {{"low", bin.low}, {"high", bin.high}, {"queries", bin.queries}};
      one["systems"] = std::move(systems);
      one["difference"] = bin.difference ? Json{{"value", bin.difference->difference},
                                                {"low", json_of(bin.difference->low)},
                                                {"high", json_of(bin.difference->high)},
                                                {"p", bin.difference->p}}
                                         : Json();
      bins.push_back(std::move(one));
    }
    list.push_back({{"level", level_name(suite.levels[curve.level])},
                    {"labels", name(curve.labels)},
                    {"category", curve.category},
                    {"by", curve.by},
                    {"unit", curve.unit},
                    {"bins", std::move(bins)}});
  }
  return list;
}

std::string graded_image_name(const Labels& labels, const Level& level) {
  return fmt::format("graded-{}-{}.png", name(labels), level_name(level));
}

std::vector<GradedChart> graded_charts(const Suite& suite, std::span<const Row> rows) {
  const std::vector<GradedCurve> curves = graded_curves(suite, rows);
  std::vector<GradedChart> charts;
  for (auto first = curves.begin(); first != curves.end();) {
    auto end = first;
    std::vector<Plot> plots;
    for (; end != curves.end() && end->level == first->level && end->labels == first->labels;
         ++end) {
      Plot plot{title(*end), end->unit, "success, %", {}};
      const double range = end->bins.back().high - end->bins.front().low;
      // The range covers all bins and all shares, so that panels and pages can be compared.
      plot.x_range = {end->bins.front().low, end->bins.back().high};
      plot.y_range = {0.0, 100.0};
      for (std::size_t s = 0; s < suite.systems.size(); ++s) {
        Series line{suite.systems[s].name, false, {}, {}}, dots{"", true, {}, {}};
        for (const GradedBin& bin : end->bins) {
          const auto& share = bin.systems[s];
          if (!share) continue;
          // Shifted sideways, so that no interval hides another.
          const double aside =
              0.012 * range *
              (static_cast<double>(s) - 0.5 * static_cast<double>(suite.systems.size() - 1));
          const Series::Point at{0.5 * (bin.low + bin.high) + aside, 100 * share->success};
          line.points.push_back(at);
          dots.points.push_back(at);
          dots.bars.emplace_back(100 * share->low, 100 * share->high);
        }
        plot.series.push_back(std::move(line));
        plot.series.push_back(std::move(dots));
      }
      plots.push_back(std::move(plot));
    }
    const Level& level = suite.levels[first->level];
    charts.push_back({graded_image_name(first->labels, level),
                      {fmt::format("{}: graded queries, {}, level {}", suite.name,
                                   with_labels(first->labels), level_name(level)),
                       std::move(plots)}});
    first = end;
  }
  return charts;
}

}  // namespace mh
