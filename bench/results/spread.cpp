// SPDX-License-Identifier: Apache-2.0
#include "bench/results/spread.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/protocol/metrics/averages.hpp"

namespace mh {
namespace {

/// Ranks from 1, ties in the middle of theirs.
std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[i]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    for (std::size_t k = first; k < end; ++k)
      ranks[order[k]] = 0.5 * static_cast<double>(first + end + 1);
    first = end;
  }
  return ranks;
}

}  // namespace

Spread::Change moved(const std::string& name, const Trajectory& unchanged,
                     const Trajectory& changed, double offered) {
  const TrajectoryScore score =
      score_trajectory(changed, unchanged, static_cast<std::size_t>(offered));
  return {name, score.ate_rmse_m, offered > 0 ? score.scored / offered : 0};
}

Trajectory turned_back(const Trajectory& backward, Stamp first_ns, Stamp last_ns) {
  Trajectory forward = backward;
  for (TimedPose& pose : forward) pose.stamp_ns = first_ns + last_ns - pose.stamp_ns;
  std::ranges::reverse(forward);
  return forward;
}

std::optional<double> rank_of_truth(std::span<const Spread> all) {
  std::vector<double> spreads, errors;
  for (const Spread& spread : all)
    if (spread.median_m && spread.ate_rmse_m) {
      spreads.push_back(*spread.median_m);
      errors.push_back(*spread.ate_rmse_m);
    }
  if (spreads.size() < 4) return std::nullopt;
  const std::vector<double> a = ranks_of(spreads), b = ranks_of(errors);
  const double middle = mean(a);
  double products = 0, squares_a = 0, squares_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    products += (a[i] - middle) * (b[i] - middle);
    squares_a += (a[i] - middle) * (a[i] - middle);
    squares_b += (b[i] - middle) * (b[i] - middle);
  }
  if (squares_a == 0 || squares_b == 0) return std::nullopt;
  return products / std::sqrt(squares_a * squares_b);
}

}  // namespace mh
