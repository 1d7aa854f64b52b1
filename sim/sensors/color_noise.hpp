// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/sensors/sensors.hpp"

namespace mh {

/// Turns light into the 8-bit image of a sensor: exposure gain, vignetting, shot and read noise
/// in linear light, then Gaussian noise in gray levels, then what its
/// processing makes of it (see SensorConfig).
void develop(Grid2d<Rgb8>& color, const Camera& camera, const SensorConfig& config, double gain,
             RandomStream stream);

}  // namespace mh
