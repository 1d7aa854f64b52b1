// SPDX-License-Identifier: Apache-2.0
#pragma once

// Keyframe-candidate selection: equations 3 to 6 (Algorithm 1) of "Spatial Perception by
// Object-Aware Visual Scene Representation". Depends only on the standard library.

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace mh {

template <class Key>
struct Candidate {
  Key keyframe{};
  double score = 0;  ///< `a` of equation 5: summed similarity of the keyframe's neighborhood
};

/// Result of Algorithm 1, with the number of keyframes left after each step.
template <class Key>
struct CandidateSelection {
  std::vector<Candidate<Key>> candidates;  ///< equation 6; descending score, ties by key
  int c1 = 0, c2 = 0, c3 = 0;
};

/// Algorithm 1. Comparisons are strict, as in the paper. The paper leaves two points open: if
/// several keyframes are replaced by the same best neighbor, it is kept once, with the highest
/// score; if neighbors are equally similar, the smallest key wins.
/// @param keyframes   all keyframes of the map; those that share nothing with the view may be left
///                    out.
/// @param overlap     overlap(k) -> n of equation 3, 0 = nothing shared.
/// @param neighbors   neighbors(k) -> range of keyframes: k itself and its neighbors.
/// @param similarity  similarity(k) -> similarity of the view and keyframe k, at least 0; a larger
///                    value means more similar. The paper's ||L_f, L_k||_1, see
///                    augmented_vector.hpp.
/// @param alpha, beta thresholds of equations 4 and 6, in [0, 1).
template <class Key, class Overlap, class Neighbors, class Similarity>
CandidateSelection<Key> select_candidates(std::span<const Key> keyframes, Overlap overlap,
                                          Neighbors neighbors, Similarity similarity, double alpha,
                                          double beta) {
  CandidateSelection<Key> selection;

  // Equation (3)
  struct Shared {
    Key keyframe;
    int n;
  };
  std::vector<Shared> c1;
  int max_n = 0;
  for (const Key& k : keyframes)
    if (const int n = overlap(k); n != 0) {
      c1.push_back({k, n});
      max_n = std::max(max_n, n);
    }
  selection.c1 = static_cast<int>(c1.size());

  // Equation (4)
  std::vector<Key> c2;
  for (const Shared& shared : c1)
    if (shared.n > alpha * max_n) c2.push_back(shared.keyframe);
  selection.c2 = static_cast<int>(c2.size());

  // Equation (5)
  std::vector<Candidate<Key>> c3;
  for (const Key& k : c2) {
    Candidate<Key> best{k, 0.0};
    double best_similarity = -1.0;
    double sum = 0.0;
    for (const Key& neighbor : neighbors(k)) {
      const double s = similarity(neighbor);
      sum += s;
      if (s > best_similarity || (s == best_similarity && neighbor < best.keyframe)) {
        best_similarity = s;
        best.keyframe = neighbor;
      }
    }
    best.score = sum;
    c3.push_back(best);
  }
  std::sort(c3.begin(), c3.end(), [](const auto& x, const auto& y) {
    return x.keyframe != y.keyframe ? x.keyframe < y.keyframe : x.score > y.score;
  });
  c3.erase(std::unique(c3.begin(), c3.end(),
                       [](const auto& x, const auto& y) { return x.keyframe == y.keyframe; }),
           c3.end());
  selection.c3 = static_cast<int>(c3.size());

  // Equation (6)
  std::stable_sort(c3.begin(), c3.end(),
                   [](const auto& x, const auto& y) { return x.score > y.score; });
  for (const Candidate<Key>& candidate : c3)
    if (candidate.score > beta * c3.front().score) selection.candidates.push_back(candidate);
  return selection;
}

}  // namespace mh
