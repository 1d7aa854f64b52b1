// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "bench/suite/run_spec.hpp"

namespace mh {

/// The part of a suite's runs that one machine takes: share `index` of split_runs().
struct Shard {
  std::size_t index = 1, of = 1;
};

/// Reads "i/n", for example "2/3". @throws InputError unless 1 <= i <= n.
Shard parse_shard(const std::string& text);

/// Names the images that a run sees: the same text for runs of the same environment at the same
/// level.
std::string images_of(const RunSpec& run);

/// Predicted processor time of a run, known before anything has run. Used to balance shares;
/// docs/measurements/cost_of_the_bench.md compares it with measured times.
struct PredictedCost {
  std::string images;   ///< from images_of()
  double images_s = 0;  ///< for making these images; spent once for all runs that see them
  double own_s = 0;     ///< for tracking, queries, noise, episodes
};

/// Predicts from the lengths of the tours: `handheld:SEED:FRAMES` states its length, others count
/// as 600 frames, and max_frames limits all. Images of a recording cost nothing.
PredictedCost predicted_cost(const RunSpec& run);

/// Consecutive runs, [begin, end).
struct PredictedShare {
  std::size_t begin = 0, end = 0;
  double predicted_s = 0;
};

/// Splits runs into consecutive shares of about equal predicted cost. Minimizes the sum of the
/// eighth powers of the shares' costs, which approximately minimizes the cost of the most expensive
/// share. A share that starts in the middle of runs with the same images must render those images
/// again. Every run is in exactly one share; if there are more parts than runs, the last shares are
/// empty.
/// @param runs  runs that see the same images are consecutive, as expand() orders them
/// @returns `parts` shares
std::vector<PredictedShare> split_runs(std::span<const PredictedCost> runs, std::size_t parts);
std::vector<PredictedShare> split_runs(std::span<const RunSpec> runs, std::size_t parts);

}  // namespace mh
