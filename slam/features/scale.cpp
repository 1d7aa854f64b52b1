// SPDX-License-Identifier: Apache-2.0
#include "slam/features/scale.hpp"

#include <array>
#include <cmath>

namespace mh {

double level_scale(const FeatureConfig& config, int octave) {
  // Asked for thousands of times per frame, always with one scale: its powers are remembered.
  constexpr int kRemembered = 16;
  thread_local double scale = 0;
  thread_local std::array<double, kRemembered> power{};
  if (octave < 0 || octave >= kRemembered) return std::pow(config.scale, octave);
  if (scale != config.scale) {
    scale = config.scale;
    for (int i = 0; i < kRemembered; ++i) power[static_cast<std::size_t>(i)] = std::pow(scale, i);
  }
  return power[static_cast<std::size_t>(octave)];
}

}  // namespace mh
