// SPDX-License-Identifier: Apache-2.0
#include "slam/features/scale.hpp"

#include <array>
#include <cmath>

namespace mh {
namespace {

// Called thousands of times per frame, always with the same scale, so the powers are cached.
struct Powers {
  static constexpr int kCount = 16;
  double scale = 0, log = 0;
  std::array<double, kCount> power{};
};

const Powers& powers_of(double scale) {
  thread_local Powers powers;
  if (powers.scale == scale) return powers;
  powers.scale = scale;
  powers.log = std::log(scale);
  for (int i = 0; i < Powers::kCount; ++i)
    powers.power[static_cast<std::size_t>(i)] = std::pow(scale, i);
  return powers;
}

}  // namespace

double level_scale(const FeatureConfig& config, int octave) {
  if (octave < 0 || octave >= Powers::kCount) return std::pow(config.scale, octave);
  return powers_of(config.scale).power[static_cast<std::size_t>(octave)];
}

double log_of_scale(const FeatureConfig& config) {
  return powers_of(config.scale).log;
}

}  // namespace mh
