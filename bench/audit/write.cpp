// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/write.hpp"

#include <type_traits>

#include <fmt/format.h>

#include "bench/report/text_table.hpp"
#include "bench/suite/json_fields.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

Json row_json(const AuditRow& row) {
  Json json = {{"level", row.level},
               {"system", row.system},
               {"labels", row.labels},
               {"settings", row.settings},
               {"environment", row.environment.empty() ? Json() : Json(row.environment)},
               {"query_set", name(row.set)}};
  json.update(json_of(row.summary));
  Json& matches = json["matches"] = Json::object();
  for (const MatchStage stage : kMatchStages) {
    const StageMatches& m = row.summary.matches[static_cast<std::size_t>(stage)];
    Json of_stage;
    for (const auto& [key, counts] :
         {std::pair("with_xi", &m.with_xi), std::pair("without_xi", &m.without_xi)}) {
      Json& gates = of_stage[key] = Json::object();
      gates["precision"] = json_of(counts->precision());
      gates["recall"] = json_of(counts->recall());
      for (std::size_t g = 0; g < kMatchGates; ++g)
        gates[std::string(name(static_cast<MatchGate>(g)))] = {{"right", counts->right[g]},
                                                               {"wrong", counts->wrong[g]}};
    }
    of_stage["xi"] = json_of(m.xi);
    matches[std::string(name(stage))] = std::move(of_stage);
  }
  return json;
}

/// Writes the fields of a query as cells, or their names.
class CsvVisitor {
 public:
  explicit CsvVisitor(bool names) : names_(names) {}

  template <class T>
  void operator()(const char* name, const T& value) {
    if constexpr (std::is_same_v<T, MatchAudit>)
      matches(value);
    else
      put(name, value);
  }
  template <class T>
  void put(std::string_view name, const T& value) {
    if (!text_.empty()) text_ += ',';
    text_ += names_ ? std::string(name) : cell(value);
  }
  std::string take() { return std::move(text_) + "\n"; }

 private:
  void matches(const MatchAudit& audit) {
    for (const MatchStage stage : kMatchStages) {
      const StageMatches& m = audit[static_cast<std::size_t>(stage)];
      const auto put_of_stage = [&](std::string_view what, std::int64_t value) {
        put(fmt::format("{}_{}", name(stage), what), value);
      };
      put_of_stage("kept_right", m.with_xi.kept_right());
      put_of_stage("kept_wrong", m.with_xi.kept_wrong());
      put_of_stage("kept_right_at_xi_1", m.without_xi.kept_right());
      put_of_stage("kept_wrong_at_xi_1", m.without_xi.kept_wrong());
      fields(m.xi, put_of_stage);
    }
  }
  template <class T>
  static std::string cell(const T& value) {
    if constexpr (requires { value.has_value(); })
      return value ? cell(*value) : std::string();
    else if constexpr (std::is_same_v<T, bool>)
      return value ? "1" : "0";
    else if constexpr (std::is_enum_v<T>)
      return std::string(name_of(value, words(value)));
    else if constexpr (std::is_convertible_v<T, std::string_view>)
      return csv_cell(std::string(value));
    else
      return fmt::format("{}", value);
  }

  bool names_;
  std::string text_;
};

std::string csv_row(const AuditedRun& run, const SemanticConfig& point, QuerySet set,
                    const QueryAudit& query, bool names = false) {
  CsvVisitor visit(names);
  visit.put("run", run.spec.name);
  visit.put("environment", run.spec.environment.name);
  visit.put("category", run.spec.environment.category);
  visit.put("level", level_name(run.spec.level));
  visit.put("system", run.spec.system.name);
  visit.put("labels", name(run.spec.labels));
  visit.put("trial", run.spec.trial);
  const auto put_setting = [&](const char* setting, const auto& value, const SettingRange&,
                               const char*) { visit.put(setting, value); };
  fields(point, put_setting);
  visit.put("query_set", name(set));
  fields(query, visit);
  return visit.take();
}

}  // namespace

nlohmann::ordered_json audit_json(const Suite& suite, std::span<const AuditedRun> runs) {
  Json json = {{"suite", suite.name},
               {"definitions",
                {{"same_place_m", kSamePoint_m},
                 {"same_place_share_of_depth", kSamePointShare},
                 {"in_sight", kInSight},
                 {"relevant", kRelevant},
                 {"nearest_keyframes", kNearest},
                 {"border_px", kBorder_px}}}};
  for (const AuditedRun& run : runs) json["runs"][run.spec.name] = run.key;
  for (const bool by_environment : {false, true}) {
    Json& rows = json[by_environment ? "environments" : "rows"] = Json::array();
    for (const AuditRow& row : audit_rows(suite, runs, by_environment))
      rows.push_back(row_json(row));
  }
  Json& cost = json["cost"] = Json::array();
  for (const AuditedRun& run : runs)
    cost.push_back({{"run", run.spec.name},
                    {"audit_s", run.audit.audit_s},
                    {"run_s", run.audit.run_s},
                    {"map_from_cache", run.audit.map_from_cache}});
  return json;
}

std::string audit_csv(std::span<const AuditedRun> runs) {
  std::string text = csv_row({}, {}, {}, {}, /*names=*/true);
  for (const AuditedRun& run : runs)
    for (std::size_t p = 0; p < run.audit.points.size(); ++p)
      for (const QuerySet set : kQuerySets)
        for (const QueryAudit& query : queries(run.audit.points[p], set))
          text += csv_row(run, run.spec.points[p], set, query);
  return text;
}

}  // namespace mh
