// SPDX-License-Identifier: Apache-2.0
#include "slam/vocabulary/vocabulary.hpp"

#include <cassert>

namespace mh {

Vocabulary::Quantized Vocabulary::quantize(const Descriptor& descriptor) const {
  assert(!nodes_.empty());
  std::uint32_t index = 0;
  std::uint32_t ancestor = 0;
  for (int level = 0; nodes_[index].child_count > 0; ++level) {
    const Node* child = &nodes_[nodes_[index].first_child];
    const std::uint32_t count = nodes_[index].child_count;
    std::uint32_t best = 0;
    int best_distance = hamming(child[0].centre, descriptor);
    for (std::uint32_t i = 1; i < count; ++i)
      if (const int distance = hamming(child[i].centre, descriptor); distance < best_distance) {
        best = i;
        best_distance = distance;
      }
    index = nodes_[index].first_child + best;
    if (level < kDirectIndexLevel) ancestor = index;
  }
  return {nodes_[index].word, ancestor};
}

}  // namespace mh
