// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/features/features.hpp"

namespace mh {

/// config.scale^octave: pixel size at a pyramid level relative to the full image.
double level_scale(const FeatureConfig& config, int octave);
/// ln(config.scale).
double log_of_scale(const FeatureConfig& config);

}  // namespace mh
