// SPDX-License-Identifier: Apache-2.0
#include "bench/report/pages/tables.hpp"

#include <functional>

#include <fmt/format.h>

#include "bench/report/episodes_report.hpp"
#include "bench/report/pages/page_table.hpp"
#include "bench/report/table2.hpp"
#include "bench/report/wording.hpp"
#include "bench/results/published.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

const PageColumn kSystem{"system", "system"}, kLevel{"level", "level"}, kLabels{"labels", "labels"},
    kQueries{"query_set", "queries"};

PageColumn page_column(const Table2Column& column) {
  return {.key = std::string(column.key),
          .title = std::string(column.title),
          .unit = std::string(column.unit),
          .decimals = column.decimals};
}

/// Begins a row with figures that the paper published.
void begin_published(PageTable& table, std::string_view system) {
  table.begin_row();
  table.text(kSystem, system);
  table.text(kQueries, "published, other data");
}

void begin(PageTable& table, const Suite& suite, const CategoryRow& row) {
  table.begin_row();
  table.text(kSystem, suite.systems[row.system].name);
  table.text(kLevel, level_name(suite.levels[row.level]));
  table.text(kLabels, labels_seen(suite, row.system, row.labels));
}

bool is_whole_suite(const Suite& suite, const CategoryRow& row) {
  return row.category == kAllCategories && row.parameters == 0 &&
         is_own_row(suite, row.system, row.labels);
}

/// A remark that qualifies a row's figures; empty if they need none.
std::string remark_on(const Suite& suite, const CategoryRow& row, const QuerySummary& queries) {
  std::string missing = incomplete(row);
  if (!missing.empty() || !is_saturated(suite.systems[row.system], queries)) return missing;
  return "saturated: too many successes to show a difference";
}

/// A key of audit.json as a heading: "matches.words.with_xi" -> "matches: words: with xi".
std::string shown_key(const std::string& path) {
  std::string text;
  for (const char c : path) text += c == '_' ? " " : c == '.' ? ": " : std::string(1, c);
  return text;
}

}  // namespace

std::string labels_seen(const Suite& suite, std::size_t system, const Labels& labels) {
  return suite.systems[system].sees_labels() ? name(labels) : "none";
}

bool is_own_row(const Suite& suite, std::size_t system, const Labels& labels) {
  return suite.systems[system].sees_labels() || labels == suite.labels.front();
}

std::vector<Arm> arms_of(const Suite& suite) {
  std::vector<Arm> arms;
  for (std::size_t s = 0; s < suite.systems.size(); ++s)
    for (const Labels& labels : suite.labels)
      if (is_own_row(suite, s, labels)) {
        const std::string seen = labels_seen(suite, s, labels);
        const bool tells = suite.labels.size() > 1 && seen != "none";
        arms.push_back({s, seen, suite.systems[s].name + (tells ? ", " + seen : "")});
      }
  return arms;
}

std::string definitions_text(const Suite& suite) {
  return fmt::format(
      "Success: a pose was returned, right or wrong. Correct: returned, and within {:g} m and "
      "{:g}° of the true pose, measured from the nearest mapped frame: a bent map is no error of "
      "its "
      "answers. False positive: returned, and not correct.",
      suite.protocol.correct_distance_m, suite.protocol.correct_angle_deg);
}

Json table1_json(const Suite& suite, std::span<const CategoryRow> rows) {
  if (suite.environments.size() < 2) return nullptr;
  PageTable table("Table 1: by category",
                  "Per environment the median over trials, then the mean over environments. The "
                  "paper's own figures by category are not part of this program.");
  for (const CategoryRow& row : rows) {
    if (row.parameters != 0 || !is_own_row(suite, row.system, row.labels)) continue;
    begin(table, suite, row);
    table.text({"category", "category"}, row.category);
    table.number({"scenes", "environments"}, static_cast<double>(row.scenes));
    if (row.scenes > 0) table.figures(figures_of(row.trajectory));
    for (const QuerySet set : kQuerySets)
      if (summary(row, set).queries > 0)
        for (const Figure& figure : figures_of(summary(row, set)))
          if (figure.metric.in_overview)
            table.figures({figure}, fmt::format("{}.", name(set)),
                          fmt::format("{}: ", short_title(set)));
    table.text({"remark", "remark"}, remark_on(suite, row, row.held_out));
  }
  return table.json();
}

Json table2_json(const Suite& suite, std::span<const CategoryRow> rows) {
  const std::span<const PublishedRow> published = published_rows(suite);
  PageTable table("Table 2: relocalization",
                  "Means over all environments of the suite. " + definitions_text(suite) +
                      (published.empty() ? ""
                                         : " Published, other data: a real house of 60 m², labels "
                                           "from YOLOv3's boxes."));
  for (const QuerySet set : kQuerySets)
    for (const CategoryRow& row : rows) {
      const QuerySummary& s = summary(row, set);
      if (!is_whole_suite(suite, row) || s.queries == 0) continue;
      begin(table, suite, row);
      table.text(kQueries, name(set));
      for (const Table2Column& column : kTable2Columns)
        table.number(page_column(column), column.measured(s));
      table.text({"remark", "remark"}, remark_on(suite, row, s));
    }
  if (table.rows() == 0) return nullptr;  // no queries
  for (const PublishedRow& row : published) {
    begin_published(table, row.system);
    for (const Table2Column& column : kTable2Columns)
      if (column.published != nullptr) table.number(page_column(column), row.*column.published);
  }
  return table.json();
}

Json published_ate_json(const Suite& suite, std::span<const Row> rows) {
  const AteBesidePublished ate = ate_beside_published(suite, rows);
  if (ate.environments.empty()) return nullptr;
  PageTable table("Beside published ATE",
                  "RMSE, m. The published figures are of all frames; here the test frames are held "
                  "out.");
  for (std::size_t e = 0; e < ate.environments.size(); ++e) {
    table.begin_row();
    table.text({"environment", "environment"}, ate.environments[e]);
    for (std::size_t s = 0; s < ate.systems.size(); ++s)
      table.number({ate.systems[s], ate.systems[s], "m", 4}, ate.ate_m[e][s]);
  }
  return table.json();
}

Json episodes_page_json(const Suite& suite, std::span<const RunResult> runs) {
  if (!suite.episodes) return nullptr;
  PageTable table("Episodes of a kidnapped robot",
                  fmt::format("Over all environments of the suite. Success: it said that it has "
                              "arrived, and is within {:g} m of such an object, no wall between.",
                              suite.episodes->arrival_m));
  for (const EpisodeVariant& variant : suite.episodes->variants)
    for (const SystemSpec& system : suite.systems) {
      table.begin_row();
      table.text(kSystem, system.name);
      table.text({"variant", "variant"}, variant.name);
      table.figures(figures_of(summarize(episodes_of(runs, system.name, variant.name))));
    }
  return table.json();
}

Json candidates_json(const Suite& suite, std::span<const CategoryRow> rows) {
  PageTable table("Section 3.3.3: candidates left after each step of Algorithm 1",
                  "Shares of the map's keyframes: ratios of means over queries. The paper gives "
                  "shares after three steps: the third may be that after equation 6.");
  const PageColumn keyframes{"keyframes", "keyframes", "", 1}, c1{"c1", "sharing (eq. 3)", "%", 2},
      c2{"c2", "sharing enough (eq. 4)", "%", 2}, c3{"c3", "neighborhoods (eq. 5)", "%", 2},
      left{"final", "candidates (eq. 6)", "", 2}, single{"single", "exactly one left", "%", 2},
      mass{"label_mass", "label mass", "%", 1};
  for (const QuerySet set : kQuerySets)
    for (const CategoryRow& row : rows) {
      const QuerySummary& s = summary(row, set);
      if (!is_whole_suite(suite, row) || s.queries == 0 || !s.keyframes || *s.keyframes <= 0)
        continue;
      const auto share = [&](const std::optional<double>& count) {
        return count ? std::optional(*count / *s.keyframes) : std::nullopt;
      };
      begin(table, suite, row);
      table.text(kQueries, name(set));
      table.number(keyframes, s.keyframes);
      table.number(c1, share(s.c1));
      table.number(c2, share(s.c2));
      table.number(c3, share(s.c3));
      table.number(left, s.final);
      table.number(single, s.single_candidate);
      table.number(mass, s.label_mass);
    }
  if (table.rows() == 0) return nullptr;
  for (const PublishedCandidates& row : published_candidates(suite)) {
    begin_published(table, row.system);
    table.number(c1, row.c1);
    table.number(c2, row.c2);
    table.number(c3, row.c3);
    table.number(left, row.final);
    table.number(single, row.single);
  }
  return table.json();
}

Json audit_tables_json(const PagesSource& source) {
  if (!source.audit.is_object()) return nullptr;
  Json tables = Json::array();
  for (const auto& [key, title] :
       {std::pair("rows", "Over all environments"), std::pair("environments", "By environment")}) {
    if (!source.audit.contains(key) || !source.audit.at(key).is_array()) continue;
    PageTable table(title, "Exact truth of each scene: matches, candidates, first causes.");
    // Objects within a row become columns "matches.words.with_xi.precision".
    const std::function<void(const std::string&, const Json&)> put = [&](const std::string& path,
                                                                         const Json& value) {
      const bool is_share = value.is_number_float();
      if (value.is_object())
        for (const auto& [inner, next] : value.items())
          put(path.empty() ? inner : path + "." + inner, next);
      else if (value.is_string())
        table.text({path, shown_key(path)}, value.get_ref<const std::string&>());
      else if (value.is_number())
        table.number({path, shown_key(path), "", is_share ? 3 : 0}, value.get<double>());
    };
    for (const Json& row : source.audit.at(key)) {
      table.begin_row();
      put("", row);
    }
    if (table.rows() > 0) tables.push_back(table.json());
  }
  return {{"tables", tables}, {"definitions", source.audit.value("definitions", Json())}};
}

}  // namespace mh
