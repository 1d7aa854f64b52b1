// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/stress_spec.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sim/sensors/dose.hpp"
#include "slam/io/settings_io.hpp"

namespace mh {
namespace {

StressDial read_dial(const std::string& name, YamlReader node) {
  if (!is_dial(name)) node.fail(no_dial(name));
  StressDial dial;
  dial.dial = dial.name = name;
  MappingReader reader(node);
  fields(dial, reader);
  const DialFacts facts = facts_of_dial(name);
  for (const auto& [key, dose] : {std::pair("from", dial.from), std::pair("to", dial.to)}) {
    if (!allows(facts.range, dose))
      node.at(node.has(key) ? key : "to")
          .fail(fmt::format("{} is outside {}", dose, interval(facts.range)));
  }
  if (facts.whole && (dial.from != std::floor(dial.from) || dial.to != std::floor(dial.to)))
    node.fail("takes whole numbers only");
  if (dial.times == 0) node.at("times").fail("0 would show every dose as the same");
  if (dial.usual && !allows(facts.range, *dial.usual))
    node.at("usual").fail(fmt::format("{} is outside {}", *dial.usual, interval(facts.range)));
  if (!dial.usual && !dial.source.empty())
    node.at("source").fail("is of `usual`, which is missing");
  if (dial.from == dial.to) node.at("to").fail("is no fault: it equals `from`");
  if (dial.scale == DoseScale::kLog && (dial.from <= 0 || dial.to <= 0))
    node.at("scale").fail("log: needs doses above 0");
  if (dial.usual && dial.source.empty()) node.at("usual").fail("needs its `source`");
  node.finish();
  return dial;
}

}  // namespace

StressSpec read_stress(YamlReader node) {
  StressSpec spec;
  MappingReader reader(node);
  fields(spec, reader);
  YamlReader dials = node.at("dials");
  for (const auto& [name, dial] : dials.entries()) spec.dials.push_back(read_dial(name, dial));
  if (spec.dials.empty()) dials.fail("is empty: at least one is needed");
  node.finish();
  return spec;
}

double exact_dose_at(const StressDial& dial, double share) {
  return dial.scale == DoseScale::kLog ? dial.from * std::pow(dial.to / dial.from, share)
                                       : dial.from + share * (dial.to - dial.from);
}

double dose_at(const StressDial& dial, double share) {
  const double dose = exact_dose_at(dial, share);
  if (facts_of_dial(dial.dial).whole) return std::round(dose);
  // Four digits, so that a dose reads well and is what was run.
  if (dose == 0) return 0;
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(dose))) - 3);
  return std::stod(fmt::format("{:.10g}", std::round(dose / unit) * unit));
}

double share_of(const StressDial& dial, double dose) {
  return dial.scale == DoseScale::kLog ? std::log(dose / dial.from) / std::log(dial.to / dial.from)
                                       : (dose - dial.from) / (dial.to - dial.from);
}

double factor_of(const StressDial& dial) {
  return std::max(dial.to / dial.from, dial.from / dial.to);
}

double shown_dose(const StressDial& dial, double dose) {
  return dial.times * dose + dial.plus;
}

}  // namespace mh
