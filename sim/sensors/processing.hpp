// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/sensors/sensors.hpp"

namespace mh {

/// What a camera does with the image of its sensor, after noise and sRGB (order: Karaimer and
/// Brown, "A software platform for manipulating the camera imaging pipeline", ECCV 2016):
/// 1. A tone curve that steepens the middle: v of [0, 1] becomes (1 - contrast) v + contrast
///    (3 v^2 - 2 v^3), so mid-gray stays and grows 1 + contrast / 2 times as fast.
/// 2. Unsharp masking with k = sharpening (Gonzalez and Woods, "Digital Image Processing", 3rd
///    edition, equation 3.6-9): what the luma (Rec. 601) has more than its own Gaussian blur is
///    added k times to all channels. A frequency f (cycles/px) of a gray image is raised
///    1 + k (1 - exp(-2 (pi sharpening_px f)^2)) times.
void process(Grid2d<Rgb8>& color, const ProcessingConfig& config);

}  // namespace mh
