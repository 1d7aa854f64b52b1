// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/sensors/sense.hpp"

namespace mh {

/// Simulates a structured-light sensor's reading of an exact depth image (m, 0 = no surface).
Grid2d<float> noisy_depth(const Grid2d<float>& depth_m, const Camera& camera,
                          const DepthNoiseConfig& config, RandomStream stream);

/// Adds the faults of `depth_faults`: noise and ragged edges as multiples of a Kinect's, and holes.
Grid2d<float> faulty_depth(const Grid2d<float>& depth_m, const Camera& camera,
                           const DepthFaultsConfig& config, RandomStream stream);

}  // namespace mh
