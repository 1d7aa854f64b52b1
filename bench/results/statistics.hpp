// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/protocol/metrics/averages.hpp"

namespace mh {

/// One paired observation: the difference first - second of one query, where both have a value.
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
  std::string of;       ///< "held_out"; empty: the tour
  std::string labels;   ///< "exact labels"; empty: not of a specific kind
  /// In one line: "distance where both answer, m, held_out, exact labels".
  std::string text() const;
};

/// Mean difference of two systems over the same queries.
struct Comparison {
  Compared what = {};
  bool more_is_better = true;
  bool in_family = true;     ///< false: shown alongside the declared family, never judged
  std::size_t pairs = 0;     ///< queries (or scenes) where both have a value; 0: unknown
  std::size_t clusters = 0;  ///< scenes that the pooled queries come from; 0: not pooled
  double difference = 0;     ///< mean of first - second
  double low = 0, high = 0;  ///< 95 % bootstrap interval
  double p = 1;              ///< two-sided: for queries from sign flips, for scenes Wilcoxon's
  double p_holm = 1;         ///< corrected over the family (see holm)
  /// The true difference that would be detected with 80 % power at the 5 % level: 2.8 standard
  /// errors; for shares at least 3 / n, n being the yes-or-no answers behind them, since
  /// differences may exist even if none was observed (the rule of three). A mean over scenes has as
  /// many answers as its scenes have queries: it moves in far smaller steps than 1 / scenes.
  /// Infinite if even the clearest difference could not reach the 5 % level: too few pairs.
  double detectable = 0;
};

/// Two-sided p of Wilcoxon's signed-rank test of the null hypothesis that paired differences are
/// symmetric about 0 (Wilcoxon, 1945). Exact: the distribution over all signs, ties get mid-ranks;
/// differences of 0 are left out. 1 if nothing is left.
double wilcoxon_signed_rank(std::span<const double> differences);

/// Mean difference of two systems over scenes: scenes are independent, so they are resampled
/// individually for the interval, and p is Wilcoxon's. Scenes where one of the two has no value are
/// left out; with fewer than 4 left the interval is infinite.
/// @param scenes   per scene, the difference of the two systems' medians over trials
/// @param answers  yes-or-no answers behind the scenes' shares, in all; 0: they are not shares
Comparison compare_scenes(std::span<const PairedDifference> scenes, std::size_t answers,
                          std::uint64_t seed, int resamples = 10000);

/// Mean difference of two systems over the pooled queries of many scenes: each query counts
/// equally, whatever its scene. Queries of one scene depend on each other, so scenes are resampled
/// as wholes (the cluster bootstrap: Field and Welsh, 2007), and p is that of sign_flip() over the
/// sums of scenes (signs by cluster: Canay, Romano and Shaikh, 2017). With fewer than 4 scenes the
/// interval is infinite; fewer than 6 cannot be significant.
/// @param clusters  per scene, its paired queries
Comparison compare_clusters(std::span<const std::vector<PairedDifference>> clusters, bool shares,
                            std::uint64_t seed, int resamples = 10000);

/// Two-sided p of a sign-flip test (Fisher, 1935) of the null hypothesis that sums are symmetric
/// about 0: the share of sign patterns under which their mean is at least as far from 0 as the
/// observed one. Exact, over all patterns, up to 14 sums; beyond that (1 + hits) / (1 + draws) over
/// 20,000 patterns drawn from the seed.
double sign_flip(std::span<const double> sums, std::uint64_t seed);

/// Mean difference of two systems over the queries of one house. Neighboring queries see the same
/// place, so they are grouped into blocks of max(2, n^(1/3)) consecutive ones: the interval is that
/// of a circular block bootstrap (Politis and Romano, 1992), p that of sign_flip() over the sums of
/// blocks that do not overlap. Fewer than 6 such blocks cannot be significant: with 5, 2 of the 32
/// patterns are as extreme as any. Deterministic: draws come from the seed. With fewer than 4 pairs
/// the interval is infinite.
/// @param shares  whether the observations are yes or no
Comparison compare_paired(std::span<const PairedDifference> queries, bool shares,
                          std::uint64_t seed, int resamples = 10000);

/// Whether Holm's correction includes it: part of the family, with at least one pair to compare.
bool counts(const Comparison& comparison);
std::size_t family_size(std::span<const Comparison> comparisons);

/// Applies Holm's correction (Holm, 1979) in place to the comparisons for which counts() holds.
void holm(std::span<Comparison> comparisons);

/// Whether the interval of a difference ends exactly at 0. Then so few observations differ that
/// they are absent or cancel in at least 2.5 % of the resamples, while p is the probability that
/// these few have such signs: two differences that agree give an end at 0 and p = 0.5.
bool ends_at_zero(const Comparison& comparison);

/// Whether a result may be called *better*, and which system's.
enum class Verdict { kUndecided, kFirstBetter, kSecondBetter };
Verdict verdict(const Comparison& comparison);

}  // namespace mh
