// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/protocol/metrics/averages.hpp"

namespace mh {

/// One paired observation: for one query, first minus second, present if both have a value.
struct PairedDifference {
  double difference = 0;
  bool present = false;
};
/// First minus second, where both are known.
inline PairedDifference paired_difference(const std::optional<double>& first,
                                          const std::optional<double>& second) {
  return first && second ? PairedDifference{*first - *second, true} : PairedDifference{};
}

/// The quantity that two systems are compared by.
struct Compared {
  std::string measure;  ///< "success", "distance where both answer"
  std::string unit;     ///< "m"; empty for shares
  std::string of;       ///< query set: "held_out"; empty for the tour
  std::string labels;   ///< "exact labels"; empty if not about one kind of labels
  /// In one line: "distance where both answer, m, held_out, exact labels".
  std::string text() const;
};

/// Mean difference between two systems over the same queries.
struct Comparison {
  Compared what = {};
  bool more_is_better = true;
  bool in_family = true;     ///< false: shown alongside the declared family, never judged
  std::size_t pairs = 0;     ///< queries (or scenes) for which both have a value; 0: unknown
  std::size_t clusters = 0;  ///< scenes that the pooled queries come from; 0: not pooled
  double difference = 0;     ///< mean of first - second
  double low = 0, high = 0;  ///< 95 % bootstrap interval
  double p = 1;       ///< two-sided; from sign flips for queries, from Wilcoxon's test for scenes
  double p_holm = 1;  ///< corrected over the family (see holm)
  /// The true difference that would be detected with 80 % power at the 5 % level: 2.8 standard
  /// errors. For shares it is at least 3 / n (the rule of three), where n is the number of
  /// yes-or-no answers behind them, since a difference may exist even if none was observed. For a
  /// mean over scenes, n counts the queries of all scenes: such a mean moves in far smaller steps
  /// than 1 / scenes. Infinite if there are too few pairs for even the clearest difference to reach
  /// the 5 % level.
  double detectable = 0;
};

/// Two-sided p of Wilcoxon's signed-rank test of the null hypothesis that paired differences are
/// symmetric about 0 (Wilcoxon, 1945). Exact, computed over all sign patterns. Ties get mid-ranks,
/// and differences of 0 are left out. 1 if none is left.
double wilcoxon_signed_rank(std::span<const double> differences);

/// Mean difference between two systems over scenes. Scenes are independent, so they are resampled
/// individually for the interval, and p is from Wilcoxon's test. Scenes where one of the two has no
/// value are left out; with fewer than 4 scenes left, the interval is infinite.
/// @param scenes   per scene, the difference of the two systems' medians over trials
/// @param answers  total number of yes-or-no answers behind the scenes' shares; 0 if not shares
Comparison compare_scenes(std::span<const PairedDifference> scenes, std::size_t answers,
                          std::uint64_t seed, int resamples = 10000);

/// Mean difference between two systems over the pooled queries of many scenes: each query counts
/// equally, whatever its scene. Queries of one scene depend on each other, so scenes are resampled
/// as wholes (the cluster bootstrap: Field and Welsh, 2007), and p is from sign_flip() of the
/// scenes' sums (signs by cluster: Canay, Romano and Shaikh, 2017). With fewer than 4 scenes, the
/// interval is infinite; with fewer than 6, no difference can be significant.
/// @param clusters  per scene, its paired queries
Comparison compare_clusters(std::span<const std::vector<PairedDifference>> clusters, bool shares,
                            std::uint64_t seed, int resamples = 10000);

/// Two-sided p of a sign-flip test (Fisher, 1935) of the null hypothesis that sums are symmetric
/// about 0: the share of sign patterns under which their mean is at least as far from 0 as the
/// observed mean. Up to 14 sums, p is exact, over all patterns. For more sums, it is (1 + hits) /
/// (1 + draws) over 20,000 patterns drawn from the seed.
double sign_flip(std::span<const double> sums, std::uint64_t seed);

/// Mean difference between two systems over the queries of one house. Neighboring queries see the
/// same place, so they are grouped into blocks of max(2, n^(1/3)) consecutive queries. The interval
/// is from a circular block bootstrap (Politis and Romano, 1992), and p is from sign_flip() of the
/// sums of blocks that do not overlap. With fewer than 6 of these blocks, no difference can be
/// significant: with 5, the smallest possible p is 2/32. Deterministic: draws come from the seed.
/// With fewer than 4 pairs, the interval is infinite.
/// @param shares  whether the observations are yes or no
Comparison compare_paired(std::span<const PairedDifference> queries, bool shares,
                          std::uint64_t seed, int resamples = 10000);

/// Whether Holm's correction includes a comparison: it is in the family and has at least one pair.
bool counts(const Comparison& comparison);
std::size_t family_size(std::span<const Comparison> comparisons);

/// Applies Holm's correction (Holm, 1979) in place to the comparisons for which counts() holds.
void holm(std::span<Comparison> comparisons);

/// Whether the interval of a difference ends exactly at 0. This happens if so few observations
/// differ that in at least 2.5 % of the resamples they are absent or cancel out. p, in contrast, is
/// the probability that these few observations have the signs that they have: if just two
/// observations differ, with the same sign, the interval ends at 0 and p = 0.5.
bool ends_at_zero(const Comparison& comparison);

/// Whether one of two systems may be called *better*, and which one.
enum class Verdict { kUndecided, kFirstBetter, kSecondBetter };
Verdict verdict(const Comparison& comparison);

}  // namespace mh
