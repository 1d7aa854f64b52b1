// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/protocol/metrics/metrics_by_name.hpp"
#include "bench/results/gate/figures.hpp"
#include "bench/suite/gate_config.hpp"

namespace mh {

/// Number of trials needed if a system is not repeatable.
inline constexpr int kFewestRuns = 5;

/// How one measure of one system changed in one scenario.
enum class ChangeVerdict { kSame, kWithin, kBetter, kWorse };
std::string_view name(ChangeVerdict verdict);

struct Change {
  std::string scenario, system;
  const Metric* measure = nullptr;
  std::size_t pairs = 0;                          ///< number of seeds
  std::optional<double> before = {}, after = {};  ///< medians over the seeds that have the figure
  /// Median of after - before over the seeds. Infinite if the figure disappeared or appeared for
  /// most seeds: a missing figure is treated as the worst possible.
  double change = 0;
  double tolerance = 0;
  /// A true worsening of this size is detected with 80 % power: tolerance + 0.84 standard errors of
  /// the median paired change. The standard error assumes a program that is different but no worse:
  /// before and after then differ by chance alone, as independent draws with the spread s over the
  /// baseline's seeds, so it is 1.2533 sqrt(2) s / sqrt(seeds). For shares, `detectable` is at
  /// least the next multiple of 1 / queries above the tolerance. If a system is not repeatable, the
  /// spread is computed from the runs of both, and the change must also exceed the tolerance by
  /// 1.86 standard errors to count as more than chance; `detectable` includes this.
  double detectable = 0;
  bool repeatable = true;
  ChangeVerdict verdict = ChangeVerdict::kSame;
};

struct GateResult {
  std::vector<Change> changes;  ///< in the baseline's order of scenario and system, then by measure
  std::size_t runs = 0;
  std::size_t identical = 0;              ///< runs whose digest equals the baseline's
  std::vector<std::string> unrepeatable;  ///< runs of repeatable systems that differ although
                                          ///< program and machine are the same
  /// Measures with a tolerance for which neither the baseline nor the current runs have a figure:
  /// "corridor, plain-pepper: ate_rmse_m".
  std::vector<std::string> not_measured = {};
  bool same_origin = false;  ///< program, machine and settings are those of the baseline
  std::vector<std::string> changed_settings = {};  ///< settings that differ from the baseline's
  bool settings_known = true;                      ///< whether the baseline records its settings

  std::size_t worse() const;
  std::size_t better() const;
  bool passed() const { return worse() == 0 && unrepeatable.empty(); }
};

/// Pairs the runs by scenario, system and seed and judges each median paired change.
/// @param same_origin  the baseline was made by this same program with these settings on this kind
///                     of machine, so that every digest must match
/// @throws InputError if the two contain different runs.
GateResult compare(std::span<const RunFigures> baseline, std::span<const RunFigures> current,
                   const GateConfig& config, bool same_origin);

/// "blank_corridor semantic-exact-pepper 3"
std::string run_name(const RunFigures& run);

}  // namespace mh
