// SPDX-License-Identifier: Apache-2.0
#pragma once

// Semantic descriptor distance: equation 2 of "Spatial Perception by Object-Aware Visual Scene
// Representation". Depends only on the standard library; works with any descriptor and any
// distance.

#include <cstdint>

namespace mh {

/// An object label from any class list; 0 is void: unknown.
using Label = std::uint32_t;
inline constexpr Label kNoLabel = 0;

/// How equation 2 treats void.
enum class VoidPolicy {
  kUnknown,  ///< void never disagrees (the default reading)
  kIsALabel  ///< void differs from every other label (the literal reading)
};

/// The condition l_p != l_q of equation 2.
constexpr bool labels_disagree(Label p, Label q, VoidPolicy policy = VoidPolicy::kUnknown) {
  return p != q && (policy == VoidPolicy::kIsALabel || (p != kNoLabel && q != kNoLabel));
}

/// Equation 2: dist(p, q) = delta_pq * ||p, q||, with delta_pq = xi if the labels disagree, else 1.
/// @param distance  ||p, q|| in any unit, e.g. the Hamming distance in bits.
/// @param xi        penalty factor, >= 1; with xi = 1 the result is the distance itself, bit for
///                  bit.
constexpr float semantic_distance(float distance, bool disagree, float xi) {
  return disagree ? xi * distance : distance;
}

}  // namespace mh
