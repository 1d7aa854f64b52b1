// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "slam/core/labels.hpp"

namespace mh {

/// How many classes labels distinguish: all; 13, grouped like NYUv2's 13 classes (Couprie et al.,
/// ICLR 2013); 5: floor, ceiling, structure, furniture, objects; 2: structure (floor and ceiling
/// included) and things.
enum class ClassSet { kAll, kThirteen, kFive, kTwo };

constexpr std::array<std::pair<std::string_view, ClassSet>, 4> words(ClassSet) {
  return {{{"all", ClassSet::kAll},
           {"thirteen", ClassSet::kThirteen},
           {"five", ClassSet::kFive},
           {"two", ClassSet::kTwo}}};
}

/// The class that represents `class_id` in a set: the same for all classes of a group. Void and
/// background stay as they are.
ClassId class_in(ClassSet set, ClassId class_id);

}  // namespace mh
