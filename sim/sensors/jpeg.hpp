// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Replaces an image by what is left of it after compression as JPEG with chroma at half
/// resolution. @param quality  1 to 100
void compress(Grid2d<Rgb8>& color, int quality);

}  // namespace mh
