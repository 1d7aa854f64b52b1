// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

namespace mh {

/// Shrinks pictures that are finer than anybody sees, to half, a quarter, ...: no texel becomes
/// larger than 1.2 mm on 95 % of the surface that shows the picture, which is what a pixel of a VGA
/// camera covers at 0.6 m. A photograph of 4096 x 4096 texels on a small thing would take 180 MB.
void thin_pictures(Scene& scene);

}  // namespace mh
