// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "slam/config/semantics.hpp"
#include "slam/features/features.hpp"
#include "slam/semantics/augmented_vector.hpp"

namespace mh {

class Vocabulary;

/// A frame's bag of words.
struct WordIndex {
  AugmentedVector vector;  ///< equation 1
  /// Ordered pairs (node, feature): features under the same vocabulary node may match.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> by_node;
};

WordIndex index_words(const Features& features, const Vocabulary& vocabulary,
                      const SemanticConfig& semantics);

}  // namespace mh
