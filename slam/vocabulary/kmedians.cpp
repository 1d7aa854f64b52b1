// SPDX-License-Identifier: Apache-2.0
#include "slam/vocabulary/kmedians.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace mh {
namespace {

// Bitwise majority vote: counts set bits per position.
class Majority {
 public:
  void add(const Descriptor& d) {
    for (std::size_t w = 0; w < 4; ++w)
      for (std::size_t b = 0; b < 64; ++b)
        ones_[w * 64 + b] += static_cast<std::uint32_t>((d[w] >> b) & 1U);
    ++count_;
  }
  std::uint32_t count() const { return count_; }
  Descriptor vote() const {
    Descriptor result{};
    for (std::size_t i = 0; i < 256; ++i)
      if (2 * ones_[i] > count_) result[i / 64] |= std::uint64_t{1} << (i % 64);
    return result;
  }

 private:
  std::array<std::uint32_t, 256> ones_{};
  std::uint32_t count_ = 0;
};

// Up to `limit` distinct descriptors among the members, in order of first occurrence.
std::vector<Descriptor> distinct(std::span<const Descriptor> descriptors,
                                 std::span<const std::uint32_t> members, std::size_t limit) {
  std::vector<Descriptor> found;
  for (const std::uint32_t m : members) {
    if (std::find(found.begin(), found.end(), descriptors[m]) != found.end()) continue;
    found.push_back(descriptors[m]);
    if (found.size() == limit) break;
  }
  return found;
}

std::vector<Descriptor> draw_seeds(std::span<const Descriptor> descriptors,
                                   std::span<const std::uint32_t> members, int k,
                                   RandomStream random) {
  std::vector<Descriptor> seeds = {descriptors[members[random.below(0, members.size())]]};
  std::vector<std::uint32_t> squared(members.size(), UINT32_MAX);  // distance to the nearest seed
  while (seeds.size() < static_cast<std::size_t>(k)) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const auto d = static_cast<std::uint32_t>(hamming(descriptors[members[i]], seeds.back()));
      squared[i] = std::min(squared[i], d * d);
      sum += squared[i];
    }
    if (sum == 0) break;  // every descriptor is already a seed
    std::uint64_t draw = random.below(seeds.size(), sum);
    std::size_t i = 0;
    while (draw >= squared[i]) draw -= squared[i++];
    seeds.push_back(descriptors[members[i]]);
  }
  return seeds;
}

// @returns whether any assignment changed.
bool assign(std::span<const Descriptor> descriptors, std::span<const std::uint32_t> members,
            Clusters& clusters) {
  bool changed = false;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const std::uint32_t c = nearest(clusters.centers, descriptors[members[i]]);
    changed |= c != clusters.cluster_of[i];
    clusters.cluster_of[i] = c;
  }
  return changed;
}

// Moves each center to the majority of its members; a center without members is not moved.
void recenter(std::span<const Descriptor> descriptors, std::span<const std::uint32_t> members,
              Clusters& clusters) {
  std::vector<Majority> majority(clusters.centers.size());
  for (std::size_t i = 0; i < members.size(); ++i)
    majority[clusters.cluster_of[i]].add(descriptors[members[i]]);
  for (std::size_t c = 0; c < majority.size(); ++c)
    if (majority[c].count() > 0) clusters.centers[c] = majority[c].vote();
}

// Removes centers that are nearest to no member, which changes no assignment.
void drop_empty(Clusters& clusters) {
  std::vector<std::uint32_t> new_index(clusters.centers.size(), UINT32_MAX);
  std::vector<char> used(clusters.centers.size(), 0);
  for (const std::uint32_t c : clusters.cluster_of) used[c] = 1;
  std::vector<Descriptor> kept;
  for (std::size_t c = 0; c < used.size(); ++c) {
    if (!used[c]) continue;
    new_index[c] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(clusters.centers[c]);
  }
  clusters.centers = std::move(kept);
  for (std::uint32_t& c : clusters.cluster_of) c = new_index[c];
}

}  // namespace

Clusters cluster(std::span<const Descriptor> descriptors, std::span<const std::uint32_t> members,
                 int k, int max_iterations, RandomStream random) {
  assert(!members.empty() && k >= 1);
  Clusters clusters;
  clusters.cluster_of.assign(members.size(), UINT32_MAX);

  clusters.centers = distinct(descriptors, members, static_cast<std::size_t>(k) + 1);
  if (clusters.centers.size() <= static_cast<std::size_t>(k)) {
    assign(descriptors, members, clusters);
    return clusters;
  }
  clusters.centers = draw_seeds(descriptors, members, k, random);
  for (int i = 0; i < max_iterations && assign(descriptors, members, clusters); ++i)
    recenter(descriptors, members, clusters);
  assign(descriptors, members, clusters);  // to the final centers
  drop_empty(clusters);
  return clusters;
}

}  // namespace mh
