// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/sensors/sense.hpp"

namespace mh {

/// Turns light into a sensor's 8-bit image: the share of light, exposure gain, vignetting, dirt on
/// the lens, shot and read noise in linear light, then Gaussian noise in gray levels, then the
/// camera's processing, then compression (see SensorConfig).
void develop(Grid2d<Rgb8>& color, const Camera& camera, const SensorConfig& config, double gain,
             RandomStream stream);

}  // namespace mh
