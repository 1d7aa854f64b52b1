// SPDX-License-Identifier: Apache-2.0
#include "bench/results/gate/gate.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "bench/results/statistics.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kPower80 = 0.84;  // normal quantile of 80 % power
constexpr double kSure95 = 1.86;   // Student's t, one-sided 95 %, for two sets of kFewestRuns
constexpr double kMedianOverMean = 1.2533;  // ratio of standard errors: sqrt(pi / 2)
constexpr double kRounding = 1e-12;  // sums of shares may differ by this much due to rounding

/// The runs of one scenario and system: each earlier run is paired with the later run of the same
/// seed.
struct Pairing {
  std::string scenario, system;
  std::vector<std::pair<const RunFigures*, const RunFigures*>> runs;
};

std::vector<Pairing> pair_up(std::span<const RunFigures> baseline,
                             std::span<const RunFigures> current) {
  std::vector<Pairing> pairings;
  for (const RunFigures& before : baseline) {
    const auto after = std::ranges::find_if(current, [&](const RunFigures& run) {
      return run.scenario == before.scenario && run.system == before.system &&
             run.seed == before.seed;
    });
    if (after == current.end())
      throw InputError(
          fmt::format("the baseline holds a run that the suite does not: {}", run_name(before)));
    auto pairing = std::ranges::find_if(pairings, [&](const Pairing& p) {
      return p.scenario == before.scenario && p.system == before.system;
    });
    if (pairing == pairings.end())
      pairing = pairings.insert(pairings.end(), {before.scenario, before.system, {}});
    pairing->runs.emplace_back(&before, &*after);
  }
  for (const RunFigures& after : current)
    if (std::ranges::none_of(baseline, [&](const RunFigures& run) {
          return run.scenario == after.scenario && run.system == after.system &&
                 run.seed == after.seed;
        }))
      throw InputError(fmt::format("the baseline lacks a run of the suite: {}", run_name(after)));
  return pairings;
}

std::optional<double> figure(const RunFigures& run, std::string_view name) {
  const auto found = run.values.find(name);
  return found == run.values.end() ? std::nullopt : found->second;
}

/// after - before; a figure that disappeared is infinitely worse, a new one infinitely better.
double paired_change(const std::optional<double>& before, const std::optional<double>& after,
                     Better better) {
  if (before && after) return *after - *before;
  if (!before && !after) return 0;
  const double worst = better == Better::kMore ? -kInf : kInf;
  return before ? worst : -worst;
}

/// Like median(), but for values that may be infinite: the middle of two opposite infinities is 0.
double median_with_infinities(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  if (values.size() % 2 == 1) return values[half];
  const double sum = values[half - 1] + values[half];
  return std::isnan(sum) ? 0 : 0.5 * sum;
}

double standard_deviation(const std::vector<std::optional<double>>& values) {
  std::vector<double> known;
  for (const auto& value : values)
    if (value) known.push_back(*value);
  if (known.size() < 2) return 0;
  const double center = mean(known);
  double sum = 0;
  for (const double value : known) sum += (value - center) * (value - center);
  return std::sqrt(sum / static_cast<double>(known.size() - 1));
}

/// The smallest multiple of 1 / count above the tolerance.
double next_step(double tolerance, double count) {
  return (std::floor(tolerance * count + kRounding) + 1) / count;
}

ChangeVerdict judge(double change, double tolerance, Better better) {
  if (change == 0) return ChangeVerdict::kSame;
  if (std::abs(change) <= tolerance + kRounding) return ChangeVerdict::kWithin;
  return (change > 0) == (better == Better::kMore) ? ChangeVerdict::kBetter : ChangeVerdict::kWorse;
}

Change compare(const Pairing& pairing, const Metric& measure, const Tolerance& tolerance) {
  Change c{.scenario = pairing.scenario, .system = pairing.system, .measure = &measure};
  std::vector<std::optional<double>> before, after, counts;
  std::vector<double> changes;
  for (const auto& [old_run, new_run] : pairing.runs) {
    before.push_back(figure(*old_run, measure.name));
    after.push_back(figure(*new_run, measure.name));
    if (!measure.count.empty()) counts.push_back(figure(*old_run, measure.count));
    changes.push_back(paired_change(before.back(), after.back(), measure.better));
  }
  c.pairs = changes.size();
  c.before = median_of_known(before);
  c.after = median_of_known(after);
  c.change = median_with_infinities(changes);
  c.tolerance = tolerance.of(c.before.value_or(0));
  c.repeatable = pairing.runs.front().second->repeatable;
  const double spread = c.repeatable
                            ? std::sqrt(2.0) * standard_deviation(before)
                            : std::hypot(standard_deviation(before), standard_deviation(after));
  const double error = kMedianOverMean * spread / std::sqrt(static_cast<double>(c.pairs));
  const double chance = c.repeatable ? 0 : kSure95 * error;
  c.detectable = c.tolerance + chance + kPower80 * error;
  const double count = median_of_known(counts).value_or(0);
  if (count > 0) c.detectable = std::max(c.detectable, next_step(c.tolerance, count));
  c.verdict = judge(c.change, c.tolerance + chance, measure.better);
  return c;
}

const Tolerance* tolerance_for(const GateConfig& config, std::string_view scenario,
                               std::string_view measure) {
  if (const auto own = config.of_scenario.find(scenario); own != config.of_scenario.end())
    if (const auto found = own->second.find(measure); found != own->second.end())
      return &found->second;
  const auto found = config.tolerances.find(measure);
  return found == config.tolerances.end() ? nullptr : &found->second;
}

/// Whether the measure applies to a scenario: without a second tour, for example, there are no
/// queries of that set.
bool is_asked(const Pairing& pairing, const Metric& measure) {
  return std::ranges::any_of(pairing.runs, [&](const auto& pair) {
    return pair.first->values.contains(measure.name) || pair.second->values.contains(measure.name);
  });
}

/// Whether any run has a figure for the measure.
bool occurs(const Pairing& pairing, const Metric& measure) {
  return std::ranges::any_of(pairing.runs, [&](const auto& pair) {
    return figure(*pair.first, measure.name) || figure(*pair.second, measure.name);
  });
}

std::size_t count(std::span<const Change> changes, ChangeVerdict verdict) {
  return static_cast<std::size_t>(std::ranges::count(changes, verdict, &Change::verdict));
}

}  // namespace

std::string_view name(ChangeVerdict verdict) {
  switch (verdict) {
    case ChangeVerdict::kSame:
      return "same";
    case ChangeVerdict::kWithin:
      return "within";
    case ChangeVerdict::kBetter:
      return "better";
    case ChangeVerdict::kWorse:
      return "WORSE";
  }
  return "?";
}

std::string run_name(const RunFigures& run) {
  return fmt::format("{} {} seed {}", run.scenario, run.system, run.seed);
}

std::size_t GateResult::worse() const {
  return count(changes, ChangeVerdict::kWorse);
}
std::size_t GateResult::better() const {
  return count(changes, ChangeVerdict::kBetter);
}

GateResult compare(std::span<const RunFigures> baseline, std::span<const RunFigures> current,
                   const GateConfig& config, bool same_origin) {
  GateResult result;
  result.same_origin = same_origin;
  for (const Pairing& pairing : pair_up(baseline, current)) {
    for (const auto& [before, after] : pairing.runs) {
      ++result.runs;
      if (before->digest == after->digest)
        ++result.identical;
      else if (same_origin && after->repeatable)
        result.unrepeatable.push_back(run_name(*after));
    }
    for (const Metric& measure : all_metrics()) {
      const Tolerance* tolerance = tolerance_for(config, pairing.scenario, measure.name);
      if (tolerance == nullptr) continue;
      if (occurs(pairing, measure))
        result.changes.push_back(compare(pairing, measure, *tolerance));
      else if (is_asked(pairing, measure))
        result.not_measured.push_back(
            fmt::format("{}, {}: {}", pairing.scenario, pairing.system, measure.name));
    }
  }
  return result;
}

}  // namespace mh
