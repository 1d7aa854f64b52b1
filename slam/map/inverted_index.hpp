// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "slam/core/ids.hpp"
#include "slam/semantics/augmented_vector.hpp"

namespace mh {

/// How many members of equation 1 a view shares with a keyframe.
struct SharedMembers {
  KeyframeId keyframe;
  int labels = 0;
  int words = 0;
  friend bool operator==(const SharedMembers&, const SharedMembers&) = default;
};

/// For each label and each visual word the keyframes that hold it (Sivic and Zisserman, ICCV 2003):
/// what shares something with a view is found by visiting the view's own members, not by comparing
/// it with every keyframe.
class InvertedIndex {
 public:
  void add(KeyframeId keyframe, const AugmentedVector& vector);
  /// @param vector  the one that it was added with.
  void remove(KeyframeId keyframe, const AugmentedVector& vector);
  /// Keyframes that share anything with the view, by id; the counts are those of shared_labels()
  /// and shared_words() of the two vectors.
  std::vector<SharedMembers> shared(const AugmentedVector& view) const;

 private:
  using Holders = std::vector<KeyframeId>;  // ordered by id
  std::vector<Holders> of_label_, of_word_;
};

}  // namespace mh
