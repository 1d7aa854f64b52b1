// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "slam/core/ids.hpp"
#include "slam/semantics/augmented_vector.hpp"

namespace mh {

/// Who holds which member of equation 1: for each label and word the keyframes that have it, and
/// with which weight (Sivic and Zisserman, ICCV 2003). A query touches what it shares with the map
/// and nothing else. Its figures are those of l1_similarity(), shared_labels() and shared_words()
/// against each keyframe, bit for bit, whatever the order in which keyframes came and went.
class InvertedIndex {
 public:
  /// What a query and one keyframe have in common.
  struct Score {
    KeyframeId keyframe;
    int shared_labels = 0, shared_words = 0;
    double similarity = 0;  ///< l1_similarity(), [0, 1]
    friend bool operator==(const Score&, const Score&) = default;
  };

  /// @pre the keyframe is not held.
  void add(KeyframeId keyframe, const AugmentedVector& vector);
  /// @pre the keyframe was added with this very vector.
  void erase(KeyframeId keyframe, const AugmentedVector& vector);

  /// One score for each keyframe that shares anything, in the order of their ids.
  std::vector<Score> query(const AugmentedVector& vector) const;

  std::size_t size() const { return size_; }  ///< keyframes held

 private:
  struct Posting {
    KeyframeId keyframe;
    double weight = 0;
  };
  /// Looked up by id, never walked through; each list is ordered by keyframe.
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
