// SPDX-License-Identifier: Apache-2.0
#include "bench/report/figures_json.hpp"

#include "bench/suite/json_fields.hpp"

namespace mh {

using Json = nlohmann::ordered_json;

Json figures_json(std::span<const Figure> figures) {
  Json json = Json::object();
  for (const auto& [metric, value] : figures) {
    Json* place = &json;
    std::size_t from = 0;
    for (auto dot = metric.name.find('.'); dot != std::string::npos;
         from = dot + 1, dot = metric.name.find('.', from))
      place = &(*place)[metric.name.substr(from, dot - from)];
    (*place)[metric.name.substr(from)] = json_of(value);
  }
  return json;
}

Json matches_json(const std::optional<MatchCounts>& matches) {
  if (!matches) return nullptr;
  Json all;
  for (std::size_t m = 0; m < matches->size(); ++m) {
    Json& counts = all[std::string(name(static_cast<Matcher>(m)))];
    const auto add = [&](const char* name, std::int64_t count) { counts[name] = count; };
    fields((*matches)[m], add);
  }
  return all;
}

}  // namespace mh
