// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "slam/core/ids.hpp"
#include "slam/semantics/augmented_vector.hpp"

namespace mh {

/// Inverted index over the members of equation 1: for each label and word, the keyframes that have
/// it and their weights (Sivic and Zisserman, ICCV 2003). A query visits only what it shares with
/// the map. Scores equal those of l1_similarity(), shared_labels() and shared_words() against each
/// keyframe, bit for bit, in whatever order keyframes were added and erased.
class InvertedIndex {
 public:
  /// What a query and one keyframe have in common.
  struct Score {
    KeyframeId keyframe;
    int shared_labels = 0, shared_words = 0;
    double similarity = 0;  ///< l1_similarity(), [0, 1]
    friend bool operator==(const Score&, const Score&) = default;
  };

  /// @pre the keyframe is not in the index.
  void add(KeyframeId keyframe, const AugmentedVector& vector);
  /// @pre the keyframe was added with this very vector.
  void erase(KeyframeId keyframe, const AugmentedVector& vector);

  /// One score for each keyframe that shares any member, in order of id.
  std::vector<Score> query(const AugmentedVector& vector) const;

  std::size_t size() const { return size_; }  ///< keyframes in the index

 private:
  struct Posting {
    KeyframeId keyframe;
    double weight = 0;
  };
  /// Looked up by id, never iterated over; each list is ordered by keyframe.
  using Postings = std::unordered_map<std::uint32_t, std::vector<Posting>>;

  static void insert(Postings& postings, KeyframeId keyframe,
                     const std::vector<WeightedMember>& members);
  static void remove(Postings& postings, KeyframeId keyframe,
                     const std::vector<WeightedMember>& members);

  Postings labels_, words_;
  std::size_t size_ = 0;
  std::uint32_t end_ = 0;  ///< above every id ever added
};

}  // namespace mh
