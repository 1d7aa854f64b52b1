// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/sensors/sense.hpp"

namespace mh {

/// Applies a camera's processing to the image of its sensor, after noise and sRGB (order: Karaimer
/// and Brown, "A software platform for manipulating the camera imaging pipeline", ECCV 2016):
/// 1. A tone curve that is steeper in the middle: v in [0, 1] becomes (1 - contrast) v + contrast
///    (3 v^2 - 2 v^3), so mid-gray is unchanged and the slope there is 1 + contrast / 2.
/// 2. Unsharp masking with k = sharpening (Gonzalez and Woods, "Digital Image Processing", 3rd
///    edition, equation 3.6-9): k times the difference between the luma (Rec. 601) and its own
///    Gaussian blur is added to all channels. A frequency f (cycles/px) of a gray image is
///    amplified 1 + k (1 - exp(-2 (pi sharpening_px f)^2)) times.
void process(Grid2d<Rgb8>& color, const ProcessingConfig& config);

}  // namespace mh
