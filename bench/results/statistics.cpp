// SPDX-License-Identifier: Apache-2.0
#include "bench/results/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "slam/core/random.hpp"

namespace mh {
namespace {

/// The sum and the number of the known differences in a unit that is resampled as a whole.
struct Unit {
  double sum = 0;
  std::size_t count = 0;
  void add(const PairedDifference& pair) {
    if (!pair.present) return;
    sum += pair.difference;
    ++count;
  }
};

std::vector<Unit> one_by_one(std::span<const PairedDifference> pairs) {
  std::vector<Unit> units(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) units[i].add(pairs[i]);
  return units;
}

double mean_difference(std::span<const Unit> units, std::span<const std::size_t> chosen) {
  double sum = 0;
  std::size_t count = 0;
  for (const std::size_t i : chosen) {
    sum += units[i].sum;
    count += units[i].count;
  }
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

std::vector<std::size_t> draw_blocks(std::size_t n, std::size_t block, RandomStream stream) {
  std::vector<std::size_t> chosen;
  chosen.reserve(n + block);
  for (std::uint64_t draw = 0; chosen.size() < n; ++draw) {
    const std::size_t start = stream.below(draw, n);
    for (std::size_t k = 0; k < block && chosen.size() < n; ++k) chosen.push_back((start + k) % n);
  }
  return chosen;
}

constexpr std::size_t kFewestPairs = 4;  // with fewer pairs, resampling is meaningless

/// How resamples for the interval are drawn.
struct Draws {
  std::size_t block = 1;  ///< consecutive units that are drawn together
  std::uint64_t seed = 0;
  int resamples = 0;
};

/// Computes the difference, its interval and the detectable difference by a circular block
/// bootstrap.
/// @param answers  number of yes-or-no observations behind the differences; 0 if they are not of
/// shares
Comparison resample(std::span<const Unit> units, std::size_t answers, const Draws& draws) {
  const auto& [block, seed, resamples] = draws;
  Comparison c;
  const std::size_t n = units.size();
  for (const Unit& unit : units) c.pairs += unit.count;
  std::vector<std::size_t> all(n);
  std::iota(all.begin(), all.end(), std::size_t{0});
  c.difference = mean_difference(units, all);
  const auto known = std::ranges::count_if(units, [](const Unit& unit) { return unit.count > 0; });
  if (static_cast<std::size_t>(known) < kFewestPairs) {
    c.low = -INFINITY;
    c.high = INFINITY;
    c.detectable = INFINITY;
    return c;
  }
  std::vector<double> means;
  means.reserve(static_cast<std::size_t>(resamples));
  for (int r = 0; r < resamples; ++r) {
    const RandomStream stream = RandomStream(seed).fork(static_cast<std::uint64_t>(r));
    means.push_back(mean_difference(units, draw_blocks(n, block, stream)));
  }
  std::sort(means.begin(), means.end());
  const auto at = [&](double share) {
    return means[static_cast<std::size_t>(share * static_cast<double>(means.size() - 1))];
  };
  c.low = at(0.025);
  c.high = at(0.975);
  double variance = 0;
  const double center =
      std::accumulate(means.begin(), means.end(), 0.0) / static_cast<double>(means.size());
  for (const double m : means) variance += (m - center) * (m - center);
  c.detectable = (1.96 + 0.84) * std::sqrt(variance / (static_cast<double>(means.size()) - 1.0));
  if (answers > 0) c.detectable = std::max(c.detectable, 3.0 / static_cast<double>(answers));
  return c;
}

/// With `independent` signs, two of all the sign patterns give the smallest possible two-sided p.
/// If even that p is above 0.05, nothing is detectable.
void note_least_p(Comparison& c, std::size_t independent) {
  if (std::ldexp(2.0, -static_cast<int>(independent)) > 0.05) c.detectable = INFINITY;
}

}  // namespace

std::string Compared::text() const {
  std::string all = measure;
  for (const std::string* part : {&unit, &of, &labels})
    if (!part->empty()) all += ", " + *part;
  return all;
}

Comparison compare_paired(std::span<const PairedDifference> queries, bool shares,
                          std::uint64_t seed, int resamples) {
  const auto block = std::max<std::size_t>(
      2, static_cast<std::size_t>(std::lround(std::cbrt(static_cast<double>(queries.size())))));
  const auto known =
      static_cast<std::size_t>(std::ranges::count_if(queries, &PairedDifference::present));
  Comparison c = resample(one_by_one(queries), shares ? known : 0, {block, seed, resamples});
  std::vector<double> sums;  // of the blocks that have a known difference
  for (std::size_t first = 0; first < queries.size(); first += block) {
    const auto part = queries.subspan(first, std::min(block, queries.size() - first));
    if (std::ranges::none_of(part, &PairedDifference::present)) continue;
    sums.push_back(0);
    for (const PairedDifference& q : part) sums.back() += q.present ? q.difference : 0.0;
  }
  if (c.pairs >= kFewestPairs) c.p = sign_flip(sums, seed);
  note_least_p(c, sums.size());
  return c;
}

double sign_flip(std::span<const double> sums, std::uint64_t seed) {
  constexpr std::size_t kMostExact = 14;
  constexpr std::uint64_t kDraws = 20000;
  double total = 0, size = 0;
  for (const double sum : sums) {
    total += sum;
    size += std::abs(sum);
  }
  // Patterns with the same mean count as hits even if their sums differ by rounding.
  const double limit = std::abs(total) - 1e-12 * size;
  const bool exact = sums.size() <= kMostExact;
  const std::uint64_t patterns = exact ? std::uint64_t{1} << sums.size() : kDraws;
  const RandomStream signs =
      RandomStream(seed).fork(0x51675);  // a stream different from the bootstrap's
  std::uint64_t hits = 0;
  for (std::uint64_t pattern = 0; pattern < patterns; ++pattern) {
    const RandomStream draw = signs.fork(pattern);
    std::uint64_t bits = pattern;
    double flipped = 0;
    for (std::size_t k = 0; k < sums.size(); ++k, bits >>= 1) {
      if (!exact && k % 64 == 0) bits = draw.bits(k / 64);
      flipped += (bits & 1) != 0 ? -sums[k] : sums[k];
    }
    hits += std::abs(flipped) >= limit ? 1 : 0;
  }
  const double drawn = exact ? 0 : 1;
  return (drawn + static_cast<double>(hits)) / (drawn + static_cast<double>(patterns));
}

Comparison compare_scenes(std::span<const PairedDifference> scenes, std::size_t answers,
                          std::uint64_t seed, int resamples) {
  std::vector<PairedDifference> known;
  std::vector<double> differences;
  for (const PairedDifference& scene : scenes)
    if (scene.present) {
      known.push_back(scene);
      differences.push_back(scene.difference);
    }
  Comparison c = resample(one_by_one(known), answers, {.seed = seed, .resamples = resamples});
  if (c.pairs >= kFewestPairs) c.p = wilcoxon_signed_rank(differences);
  note_least_p(c, c.pairs);
  return c;
}

Comparison compare_clusters(std::span<const std::vector<PairedDifference>> clusters, bool shares,
                            std::uint64_t seed, int resamples) {
  std::vector<Unit> units;
  std::vector<double> sums;
  std::size_t known = 0;
  for (const std::vector<PairedDifference>& cluster : clusters) {
    Unit whole;
    for (const PairedDifference& pair : cluster) whole.add(pair);
    if (whole.count == 0) continue;
    units.push_back(whole);
    sums.push_back(whole.sum);
    known += whole.count;
  }
  Comparison c = resample(units, shares ? known : 0, {.seed = seed, .resamples = resamples});
  c.clusters = units.size();
  if (c.clusters >= kFewestPairs) c.p = sign_flip(sums, seed);
  note_least_p(c, c.clusters);
  return c;
}

double wilcoxon_signed_rank(std::span<const double> differences) {
  // Differences that are equal as fractions, such as 3/23 - 2/23 and 1/23, may differ in their last
  // bits.
  double largest = 0;
  for (const double difference : differences) largest = std::max(largest, std::abs(difference));
  const double equal = 1e-9 * largest;
  std::vector<double> d;
  for (const double difference : differences)
    if (std::abs(difference) > equal) d.push_back(difference);
  std::sort(d.begin(), d.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  // Ranks are doubled, so that mid-ranks are integers.
  std::vector<std::size_t> ranks(d.size());
  for (std::size_t first = 0; first < d.size();) {
    std::size_t end = first;
    while (end < d.size() && std::abs(d[end]) - std::abs(d[first]) <= equal) ++end;
    for (std::size_t i = first; i < end; ++i) ranks[i] = first + end + 1;
    first = end;
  }
  const std::size_t all = std::accumulate(ranks.begin(), ranks.end(), std::size_t{0});
  std::size_t positive = 0;
  for (std::size_t i = 0; i < d.size(); ++i) positive += d[i] > 0 ? ranks[i] : 0;

  // probability[s] is the probability that the (doubled) ranks with a positive sign sum to s if
  // each sign is a fair coin flip.
  std::vector<double> probability(all + 1, 0.0);
  probability[0] = 1.0;
  std::size_t reached = 0;
  for (const std::size_t rank : ranks) {
    reached += rank;
    for (std::size_t s = reached + 1; s-- > 0;)
      probability[s] = 0.5 * probability[s] + (s >= rank ? 0.5 * probability[s - rank] : 0.0);
  }
  const std::size_t smaller = std::min(positive, all - positive);
  double tail = 0;
  for (std::size_t s = 0; s <= smaller; ++s) tail += probability[s];
  return std::min(1.0, 2.0 * tail);
}

bool counts(const Comparison& comparison) {
  return comparison.in_family && comparison.pairs > 0;
}

std::size_t family_size(std::span<const Comparison> comparisons) {
  return static_cast<std::size_t>(std::count_if(comparisons.begin(), comparisons.end(), counts));
}

void holm(std::span<Comparison> family) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < family.size(); ++i)
    if (counts(family[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return family[a].p < family[b].p; });
  double largest = 0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const double corrected = static_cast<double>(order.size() - rank) * family[order[rank]].p;
    largest = std::max(largest, std::min(1.0, corrected));
    family[order[rank]].p_holm = largest;
  }
}

bool ends_at_zero(const Comparison& c) {
  return c.difference != 0 && (c.low == 0 || c.high == 0);
}

Verdict verdict(const Comparison& c) {
  if (!counts(c) || c.p_holm >= 0.05 || (c.low <= 0 && c.high >= 0)) return Verdict::kUndecided;
  return (c.difference > 0) == c.more_is_better ? Verdict::kFirstBetter : Verdict::kSecondBetter;
}

}  // namespace mh
