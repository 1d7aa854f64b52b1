// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

namespace mh {

/// Downsamples images that are finer than can be seen, by 2, 4, ...: no texel becomes larger than
/// 1.2 mm on 95 % of the surface that shows the image, which is what a pixel of a VGA camera covers
/// at 0.6 m. A photograph of 4096 x 4096 texels on a small object would take 180 MB.
void thin_images(Scene& scene);

}  // namespace mh
