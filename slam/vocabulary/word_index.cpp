// SPDX-License-Identifier: Apache-2.0
#include "slam/vocabulary/word_index.hpp"

#include <algorithm>
#include <span>

#include "slam/vocabulary/vocabulary.hpp"

namespace mh {

WordIndex index_words(const Features& features, const Vocabulary& vocabulary,
                      const SemanticConfig& semantics) {
  WordIndex index;
  std::vector<Label> labels;
  std::vector<WordId> words;
  for (std::uint32_t i = 0; i < features.size(); ++i) {
    const Vocabulary::Quantized quantized = vocabulary.quantize(features.descriptors[i]);
    words.push_back(quantized.word);
    labels.push_back(features.keypoints[i].label);
    index.by_node.emplace_back(quantized.node, i);
  }
  std::sort(index.by_node.begin(), index.by_node.end());
  index.vector = augmented_vector(
      std::span<const Label>(labels), std::span<const WordId>(words), semantics.gamma,
      [&](WordId word) { return static_cast<double>(vocabulary.idf(word)); },
      semantics.void_is_a_label ? VoidPolicy::kIsALabel : VoidPolicy::kUnknown);
  return index;
}

}  // namespace mh
