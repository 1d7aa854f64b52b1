// SPDX-License-Identifier: Apache-2.0
#pragma once

// Semantically augmented scene representation: equation 1 of "Spatial Perception by Object-Aware
// Visual Scene Representation", and the L1 score over it. Depends only on the standard library.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "descriptor_distance.hpp"

namespace mh {

/// One member of the set of equation 1.
struct WeightedMember {
  std::uint32_t id = 0;  ///< label or visual word
  double weight = 0;     ///< L1-normalized share
  friend bool operator==(const WeightedMember&, const WeightedMember&) = default;
};

/// Equation 1 as one sparse vector, L1-normalized over labels and words together. Each part is
/// ordered by id and has positive weights only: an element of zero weight is not a member.
struct AugmentedVector {
  std::vector<WeightedMember> labels;
  std::vector<WeightedMember> words;

  /// Share of the L1 mass that comes from labels, in [0, 1].
  double label_mass() const {
    double mass = 0;
    for (const WeightedMember& member : labels) mass += member.weight;
    return mass;
  }
  friend bool operator==(const AugmentedVector&, const AugmentedVector&) = default;
};

namespace semantics_detail {

/// Counts equal ids: one member per distinct id, weight = count.
inline std::vector<WeightedMember> histogram(std::vector<std::uint32_t> ids) {
  std::sort(ids.begin(), ids.end());
  std::vector<WeightedMember> members;
  for (const std::uint32_t id : ids) {
    if (members.empty() || members.back().id != id) members.push_back({id, 0.0});
    members.back().weight += 1.0;
  }
  return members;
}

template <class Visit>
void for_each_common(std::span<const WeightedMember> a, std::span<const WeightedMember> b,
                     Visit visit) {
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    if (a[i].id < b[j].id) {
      ++i;
    } else if (b[j].id < a[i].id) {
      ++j;
    } else {
      visit(a[i++].weight, b[j++].weight);
    }
  }
}

}  // namespace semantics_detail

/// Equation 1: labels have weight gamma * |P_l|, visual words eta_v * |P_v|; then L1-normalized.
/// @param labels  one per keypoint; kNoLabel adds nothing (VoidPolicy::kUnknown).
/// @param words   one per keypoint.
/// @param gamma   factor of labels, >= 0.
/// @param eta     eta(word) >= 0: the word's factor, e.g. its inverse document frequency.
template <class Eta>
AugmentedVector augmented_vector(std::span<const Label> labels,
                                 std::span<const std::uint32_t> words, double gamma, Eta eta,
                                 VoidPolicy policy = VoidPolicy::kUnknown) {
  AugmentedVector vector;
  std::vector<std::uint32_t> known;
  for (const Label label : labels)
    if (label != kNoLabel || policy == VoidPolicy::kIsALabel) known.push_back(label);
  vector.labels = semantics_detail::histogram(std::move(known));
  vector.words = semantics_detail::histogram({words.begin(), words.end()});
  for (WeightedMember& member : vector.labels) member.weight *= gamma;
  for (WeightedMember& member : vector.words) member.weight *= eta(member.id);

  const auto weighs_nothing = [](const WeightedMember& member) { return !(member.weight > 0); };
  std::erase_if(vector.labels, weighs_nothing);
  std::erase_if(vector.words, weighs_nothing);
  double sum = 0;
  for (const WeightedMember& member : vector.labels) sum += member.weight;
  for (const WeightedMember& member : vector.words) sum += member.weight;
  for (WeightedMember& member : vector.labels) member.weight /= sum;
  for (WeightedMember& member : vector.words) member.weight /= sum;
  return vector;
}

/// The gamma at which labels hold the requested share of the vectors' L1 mass (equation 1), on
/// average. If a vector's share is m at gamma = 1, it is gamma m / (gamma m + 1 - m) at any gamma.
/// This grows with gamma, so bisection finds the solution.
/// @param shares_at_one  AugmentedVector::label_mass() of each vector at gamma = 1
/// @param wished         requested share, in [0, 1)
/// @param most           returned if no smaller gamma is enough, as may happen if some vectors have
///                       no labels
/// @returns 0 if no vector has labels
inline double gamma_for_label_mass(std::span<const double> shares_at_one, double wished,
                                   double most) {
  if (std::all_of(shares_at_one.begin(), shares_at_one.end(), [](double m) { return m == 0; }))
    return 0;
  // Bisects s = gamma / (1 + gamma), which is bounded.
  double low = 0, high = most / (1 + most);
  for (int step = 0; step < 60; ++step) {
    const double s = 0.5 * (low + high);
    double sum = 0;
    for (const double m : shares_at_one)
      if (m > 0) sum += s * m / (s * m + (1 - s) * (1 - m));
    (sum < wished * static_cast<double>(shares_at_one.size()) ? low : high) = s;
  }
  return high / (1 - high);
}

/// The same vector without its labels: words alone, renormalized.
inline AugmentedVector words_alone(const AugmentedVector& vector) {
  AugmentedVector plain;
  plain.words = vector.words;
  double sum = 0;
  for (const WeightedMember& member : plain.words) sum += member.weight;
  for (WeightedMember& member : plain.words) member.weight /= sum;
  return plain;
}

/// ||f, k||_1 of the paper as a similarity: 1 - |f - k|_1 / 2 over normalized vectors, in [0, 1]; 1
/// for equal vectors, 0 if nothing is shared (Nister and Stewenius, CVPR 2006). Summed over the
/// shared members only: |f - k|_1 = 2 - sum(|f| + |k| - |f - k|), so 1 - |f - k|_1 / 2 is the sum
/// of the smaller shares.
inline double l1_similarity(const AugmentedVector& f, const AugmentedVector& k) {
  double sum = 0;
  const auto add_smaller = [&](double a, double b) { sum += std::min(a, b); };
  semantics_detail::for_each_common(f.labels, k.labels, add_smaller);
  semantics_detail::for_each_common(f.words, k.words, add_smaller);
  return sum;
}

/// |L_f intersect L_k| over labels, and the same over words: the choices for n of equation 3.
inline int shared_labels(const AugmentedVector& f, const AugmentedVector& k) {
  int n = 0;
  semantics_detail::for_each_common(f.labels, k.labels, [&](double, double) { ++n; });
  return n;
}
inline int shared_words(const AugmentedVector& f, const AugmentedVector& k) {
  int n = 0;
  semantics_detail::for_each_common(f.words, k.words, [&](double, double) { ++n; });
  return n;
}

}  // namespace mh
