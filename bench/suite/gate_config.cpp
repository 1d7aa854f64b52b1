// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/gate_config.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bench/protocol/metrics/metrics_by_name.hpp"

namespace mh {
namespace {

constexpr double kMost = 1e9;

Tolerance read_tolerance(YamlReader node) {
  if (node.is_scalar()) return {.absolute = node.as_double(0.0, kMost), .relative = 0};
  Tolerance tolerance;
  tolerance.absolute = node.number_or("absolute", 0.0, 0.0, kMost);
  tolerance.relative = node.number_or("relative", 0.0, 0.0, kMost);
  node.finish();
  return tolerance;
}

Tolerances read_tolerances(YamlReader node) {
  Tolerances tolerances;
  for (const auto& [measure, value] : node.entries()) {
    if (find_metric(measure) == nullptr)
      value.fail(fmt::format("'{}' is not a measure; see docs/ci.md", measure));
    tolerances[measure] = read_tolerance(value);
  }
  return tolerances;
}

}  // namespace

double Tolerance::of(double baseline_median) const {
  return std::max(absolute, relative * std::abs(baseline_median));
}

GateConfig read_gate(YamlReader node, const std::vector<std::string>& environments) {
  GateConfig config;
  config.tolerances = read_tolerances(node.at("tolerances"));
  if (auto scenarios = node.find("scenarios"))
    for (const auto& [name, value] : scenarios->entries()) {
      if (std::ranges::find(environments, name) == environments.end())
        value.fail(fmt::format("there is no environment '{}'", name));
      config.of_scenario[name] = read_tolerances(value);
    }
  node.finish();
  return config;
}

}  // namespace mh
