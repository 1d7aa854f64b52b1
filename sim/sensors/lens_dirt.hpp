// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/sensors/config.hpp"
#include "slam/core/grid2d.hpp"

namespace mh {

/// The share of the light that reaches each pixel through a dirty lens: 1 in the clear, 1/10 behind
/// a spot. Spots are disks of 2 to 6 % of the image's width with soft borders, since they are out
/// of focus; a lens with more dirt has the same spots and others.
Grid2d<float> light_through(const LensDirtConfig& config, int width_px, int height_px);

}  // namespace mh
