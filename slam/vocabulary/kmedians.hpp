// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slam/core/random.hpp"
#include "slam/features/features.hpp"

namespace mh {

struct Clusters {
  std::vector<Descriptor> centers;        ///< distinct, each with members
  std::vector<std::uint32_t> cluster_of;  ///< per descriptor: its nearest center, ties to the first
};

/// k-medians in Hamming space: seeds drawn with probability proportional to the squared distance
/// from the nearest one already drawn (k-means++, Arthur and Vassilvitskii, SODA 2007), then
/// assignment and bitwise majority (ties give 0) alternate until assignments no longer change or
/// `max_iterations` are reached. If there are at most k distinct descriptors, each becomes its own
/// cluster. Clusters left without members are dropped.
/// @param members  indices into `descriptors`: what is clustered; not empty.
/// @returns cluster_of in the order of `members`.
Clusters cluster(std::span<const Descriptor> descriptors, std::span<const std::uint32_t> members,
                 int k, int max_iterations, RandomStream random);

/// Index of the center nearest to a descriptor, ties to the first. @pre there is at least one.
inline std::uint32_t nearest(std::span<const Descriptor> centers, const Descriptor& descriptor) {
  std::uint32_t best = 0;
  int best_distance = hamming(centers[0], descriptor);
  for (std::uint32_t i = 1; i < centers.size(); ++i)
    if (const int distance = hamming(centers[i], descriptor); distance < best_distance) {
      best = i;
      best_distance = distance;
    }
  return best;
}

}  // namespace mh
