// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "slam/io/words.hpp"

namespace mh {

/// The outcome of a pair that a matcher considered: a point that it looked for, and the feature
/// nearest to it.
enum class MatchGate {
  kKept,
  kThreshold,  ///< farther than the gate allows
  kRatio,      ///< the second nearest is about as near
  kTaken,      ///< a feature matches one point only, and another was nearer
  kRotation    ///< rotated differently from most other pairs
};
inline constexpr std::size_t kMatchGates = 5;

constexpr Names<MatchGate, kMatchGates> words(MatchGate) {
  return {{{"kept", MatchGate::kKept},
           {"threshold", MatchGate::kThreshold},
           {"ratio", MatchGate::kRatio},
           {"taken", MatchGate::kTaken},
           {"rotation", MatchGate::kRotation}}};
}
constexpr std::string_view name(MatchGate gate) {
  return name_of(gate, words(gate));
}

/// A pair, as a matcher logs it.
struct GatedPair {
  std::uint32_t asked = 0;    ///< the searched point: a feature of the first view, or a target
  std::uint32_t feature = 0;  ///< the nearest feature, after equation 2
  MatchGate gate = MatchGate::kKept;
};
using GateLog = std::vector<GatedPair>;

}  // namespace mh
