// SPDX-License-Identifier: Apache-2.0
#include "bench/results/published.hpp"

#include <algorithm>

namespace mh {

AteBesidePublished ate_beside_published(const Suite& suite, std::span<const Row> rows) {
  AteBesidePublished table;
  if (suite.published_ate_m.empty()) return table;
  for (const SystemSpec& system : suite.systems) table.systems.push_back(system.name);
  for (const auto& [system, ate_m] : suite.published_ate_m) table.systems.push_back(system);
  for (std::size_t e = 0; e < suite.environments.size(); ++e) {
    const std::string& name = suite.environments[e].name;
    std::vector<std::optional<double>> cells;
    for (std::size_t s = 0; s < suite.systems.size(); ++s) {
      const auto row = std::ranges::find_if(
          rows, [&](const Row& r) { return r.environment == e && r.system == s; });
      cells.push_back(row == rows.end() ? std::nullopt : row->trajectory.ate_rmse_m);
    }
    for (const auto& [system, ate_m] : suite.published_ate_m) {
      const auto known = ate_m.find(name);
      cells.push_back(known == ate_m.end() ? std::nullopt : std::optional(known->second));
    }
    table.environments.push_back(name);
    table.ate_m.push_back(std::move(cells));
  }
  return table;
}

}  // namespace mh
