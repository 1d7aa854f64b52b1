// SPDX-License-Identifier: Apache-2.0
#include "slam/vocabulary/vocabulary.hpp"

#include <cassert>

#include "slam/vocabulary/kmedians.hpp"

namespace mh {

Vocabulary::Quantized Vocabulary::quantize(const Descriptor& descriptor) const {
  assert(!centers_.empty());
  const std::vector<std::uint32_t>& links = *links_;
  std::uint32_t index = 0;
  std::uint32_t ancestor = 0;
  for (int level = 0; child_counts_[index] > 0; ++level) {
    const std::uint32_t first = links[index];
    index = first + nearest(centers_.subspan(first, child_counts_[index]), descriptor);
    if (level < kDirectIndexLevel) ancestor = index;
  }
  return {links[index], ancestor};
}

}  // namespace mh
