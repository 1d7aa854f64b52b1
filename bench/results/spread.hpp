// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/protocol/run_result.hpp"

namespace mh {

/// How far a system's answers move if its input changes in a way that should not matter: what can
/// be said without truth. What is wrong in the same way each time, such as the scale, is not seen.
struct Spread {
  struct Change {
    std::string name;              ///< "backward", "jpeg.loss 20"
    std::optional<double> rmse_m;  ///< between the two paths, after SE(3) alignment
    double both = 0;               ///< share of the frames that have a pose in both
  };
  std::string environment, system;
  std::vector<Change> changes;
  std::optional<double> median_m;    ///< of the changes
  std::optional<double> ate_rmse_m;  ///< of the unchanged run, where the truth is known
};

/// The distance between two paths of the same frames, after SE(3) alignment.
/// @param changed  with the stamps of `unchanged`
Spread::Change moved(const std::string& name, const Trajectory& unchanged,
                     const Trajectory& changed, double offered);

/// A path of frames that were shown backward, with the stamps that they had forward.
Trajectory turned_back(const Trajectory& backward, Stamp first_ns, Stamp last_ns);

/// Spearman's rank correlation of the spread with the true error; nullopt with fewer than 4 pairs.
std::optional<double> rank_of_truth(std::span<const Spread> all);

}  // namespace mh
