// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

namespace mh {

/// Downsamples images that are finer than can be seen, by 2, 4, ...: on 95 % of the surface that
/// shows an image, no texel becomes larger than 1.2 mm, the size that a pixel of a VGA camera
/// covers at 0.6 m. Otherwise, a photograph of 4096 x 4096 texels on a small object would take 180
/// MB.
void thin_images(Scene& scene);

}  // namespace mh
