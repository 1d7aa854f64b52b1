// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace mh {

/// What a system achieved at one dose: right answers and questions, by room.
struct DoseResult {
  double at = 0;  ///< share of the dial's range: 0 no fault, 1 the strongest dose
  std::vector<double> right = {}, asked = {};
  /// All rooms together; 0 if nothing was asked.
  double share() const;
};

/// Values that never rise, as near as possible to the given ones (least squares; pool adjacent
/// violators, Ayer et al. 1955).
std::vector<double> never_rising(std::span<const double> values);

/// Where a curve that never rises falls below the bar, by linear interpolation; nullopt if it
/// does not. @param at  ascending
std::optional<double> crossing(std::span<const double> at, std::span<const double> values,
                               double bar);

enum class Breaks { kAtDose, kNever, kBeforeAnyDose };

struct BreakingPoint {
  Breaks breaks = Breaks::kNever;
  double at = 1;             ///< share of the range; 1 if it never breaks
  double low = 0, high = 1;  ///< 95 % interval; high = 1 may be beyond the range
};

/// The dose at which what a system achieves falls below `bar` times what it achieves without a
/// fault. The interval comes from resampling the rooms, and covers at least the doses between which
/// the share was seen to fall below the bar.
/// @param doses  ascending, the first without a fault; rooms in the same order everywhere
BreakingPoint breaking_point(std::span<const DoseResult> doses, double bar, std::uint64_t seed);

/// The ratio of two systems' breaking points with its 95 % interval; rooms are resampled for both
/// together, and the interval covers what the two brackets leave open. nullopt unless both break at
/// a dose.
/// @param factor  0 for a linear dial: the ratio of the distances from no fault; otherwise the
///                factor from no fault to the strongest dose, at least 1: the ratio of the factors
struct BreakingRatio {
  double ratio = 1, low = 0, high = 0;
};
std::optional<BreakingRatio> compare_breaking(std::span<const DoseResult> first,
                                              std::span<const DoseResult> second, double bar,
                                              std::uint64_t seed, double factor = 0);

}  // namespace mh
