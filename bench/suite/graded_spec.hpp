// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "slam/io/setting.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

/// Queries drawn by their distance and angle from the nearest mapped view, the same number in each
/// cell of a grid over both.
struct GradedSpec {
  std::vector<double> distance_m, angle_deg;  ///< edges of the bins, increasing
  std::size_t per_bin = 10;                   ///< queries in each pair of bins
  std::uint64_t seed = 0;                     ///< of the draw
  /// If the mapping was a handheld scan: each query's scan is played at each of these multiples of
  /// its speed.
  std::vector<double> speed = {1.0};
  /// A drawn view is only counted, not used as a query, if the mapped frames show less than this
  /// share of its surface.
  double least_shown = 0.05;
  friend bool operator==(const GradedSpec&, const GradedSpec&) = default;
};

template <MaybeConst<GradedSpec> G, class Visit>
void fields(G& graded, Visit& v) {
  auto& [distance_m, angle_deg, per_bin, seed, speed, least_shown] = graded;
  using setting::required;
  v("distance_m", distance_m, required({0, 100}),
    "edges of the bins of the distance from the nearest mapped view");
  v("angle_deg", angle_deg, required({0, 180}), "edges of the bins of the angle from it");
  v("per_bin", per_bin, {1, 1000}, "queries in each pair of bins");
  v("seed", seed, setting::kSeed, "seed of the draw");
  v("speed", speed, {0.1, 10},
    "multiples of the speed at which each query's handheld scan is played");
  v("least_shown", least_shown, {0, 1},
    "a view is counted, not asked, if the mapped frames show less than this share of its surface");
}

/// Index of the bin that a value falls into; the number of bins if it falls into none. Bins contain
/// their lower edge.
std::size_t bin_of(const std::vector<double>& edges, double value);
inline std::size_t bins(const std::vector<double>& edges) {
  return edges.empty() ? 0 : edges.size() - 1;
}

/// Reads the section `graded` of a suite. @throws InputError naming file, line, field and value.
GradedSpec read_graded(YamlReader node);

}  // namespace mh
