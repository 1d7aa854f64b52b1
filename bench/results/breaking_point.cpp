// SPDX-License-Identifier: Apache-2.0
#include "bench/results/breaking_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "slam/core/random.hpp"

namespace mh {
namespace {

constexpr int kResamples = 2000;

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Draws rooms with replacement.
std::vector<std::size_t> draw_rooms(std::size_t rooms, RandomStream stream) {
  std::vector<std::size_t> drawn(rooms);
  for (std::size_t r = 0; r < rooms; ++r) drawn[r] = stream.below(r, rooms);
  return drawn;
}

DoseResult of_rooms(const DoseResult& all, const std::vector<std::size_t>& rooms) {
  DoseResult some{.at = all.at};
  for (const std::size_t r : rooms) {
    some.right.push_back(all.right[r]);
    some.asked.push_back(all.asked[r]);
  }
  return some;
}

/// nullopt: it never falls below the bar. 0: nothing is right without a fault.
std::optional<double> break_of(std::span<const DoseResult> doses, double bar) {
  std::vector<double> at, shares;
  for (const DoseResult& dose : doses) {
    at.push_back(dose.at);
    shares.push_back(dose.share());
  }
  if (shares.front() <= 0) return 0.0;
  const double wanted = bar * shares.front();
  return crossing(at, never_rising(shares), wanted);
}

std::vector<DoseResult> resampled(std::span<const DoseResult> doses,
                                  const std::vector<std::size_t>& rooms) {
  std::vector<DoseResult> some;
  for (const DoseResult& dose : doses) some.push_back(of_rooms(dose, rooms));
  return some;
}

/// The doses between which a share of the range lies.
std::pair<double, double> bracket_of(std::span<const DoseResult> doses, double at) {
  for (std::size_t i = 1; i < doses.size(); ++i)
    if (doses[i - 1].at <= at && at <= doses[i].at) return {doses[i - 1].at, doses[i].at};
  return {at, at};
}

/// The value below which a share of the sorted values lies.
double quantile(const std::vector<double>& sorted, double share) {
  const auto at =
      static_cast<std::size_t>(std::floor(share * static_cast<double>(sorted.size() - 1) + 0.5));
  return sorted[at];
}

}  // namespace

double DoseResult::share() const {
  const double all = sum(asked);
  return all > 0 ? sum(right) / all : 0.0;
}

std::vector<double> never_rising(std::span<const double> values) {
  struct Block {
    double mean;
    std::size_t count;
  };
  std::vector<Block> blocks;
  for (const double value : values) {
    blocks.push_back({value, 1});
    while (blocks.size() > 1 && blocks[blocks.size() - 2].mean < blocks.back().mean) {
      const Block last = blocks.back();
      blocks.pop_back();
      Block& merged = blocks.back();
      merged.mean = (merged.mean * static_cast<double>(merged.count) +
                     last.mean * static_cast<double>(last.count)) /
                    static_cast<double>(merged.count + last.count);
      merged.count += last.count;
    }
  }
  std::vector<double> smooth;
  for (const Block& block : blocks) smooth.insert(smooth.end(), block.count, block.mean);
  return smooth;
}

std::optional<double> crossing(std::span<const double> at, std::span<const double> values,
                               double bar) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] >= bar) continue;
    if (i == 0) return at[0];
    const double above = values[i - 1] - bar, fall = values[i - 1] - values[i];
    return at[i - 1] + (at[i] - at[i - 1]) * above / fall;
  }
  return std::nullopt;
}

BreakingPoint breaking_point(std::span<const DoseResult> doses, double bar, std::uint64_t seed) {
  BreakingPoint point;
  if (doses.empty() || doses.front().share() <= 0) return {Breaks::kBeforeAnyDose, 0, 0, 0};
  const std::optional<double> at = break_of(doses, bar);
  point.breaks = at ? Breaks::kAtDose : Breaks::kNever;
  point.at = at.value_or(1);
  std::vector<double> drawn;
  const RandomStream stream(seed);
  const std::size_t rooms = doses.front().asked.size();
  for (std::uint64_t k = 0; k < kResamples; ++k)
    drawn.push_back(break_of(resampled(doses, draw_rooms(rooms, stream.fork(k))), bar).value_or(1));
  std::ranges::sort(drawn);
  point.low = std::min(quantile(drawn, 0.025), point.at);
  point.high = std::max(quantile(drawn, 0.975), point.at);
  if (!at) return point;
  const auto [low, high] = bracket_of(doses, *at);
  point.low = std::min(point.low, low);
  point.high = std::max(point.high, high);
  return point;
}

std::optional<BreakingRatio> compare_breaking(std::span<const DoseResult> first,
                                              std::span<const DoseResult> second, double bar,
                                              std::uint64_t seed, double factor) {
  const auto ratio_of = [&](double x, double y) {
    return factor > 0 ? std::pow(factor, x - y) : x / y;
  };
  const std::optional<double> a = break_of(first, bar), b = break_of(second, bar);
  if (!a || !b || *a <= 0 || *b <= 0) return std::nullopt;
  std::vector<double> drawn;
  const RandomStream stream(seed);
  const std::size_t rooms = first.front().asked.size();
  for (std::uint64_t k = 0; k < kResamples; ++k) {
    const std::vector<std::size_t> some = draw_rooms(rooms, stream.fork(k));
    const double x = break_of(resampled(first, some), bar).value_or(1),
                 y = break_of(resampled(second, some), bar).value_or(1);
    if (x > 0 && y > 0) drawn.push_back(ratio_of(x, y));
  }
  if (drawn.empty()) return std::nullopt;
  std::ranges::sort(drawn);
  BreakingRatio ratio{ratio_of(*a, *b), quantile(drawn, 0.025), quantile(drawn, 0.975)};
  const auto [a_low, a_high] = bracket_of(first, *a);
  const auto [b_low, b_high] = bracket_of(second, *b);
  if (b_high > 0) ratio.low = std::min(ratio.low, ratio_of(a_low, b_high));
  ratio.high = b_low > 0 || factor > 0 ? std::max(ratio.high, ratio_of(a_high, b_low))
                                       : std::numeric_limits<double>::infinity();
  return ratio;
}

}  // namespace mh
