// SPDX-License-Identifier: Apache-2.0
#include "scenes/materials/painters.hpp"

namespace mh {

Picture paint_wood_grain(const PaintJob& job) {
  const Field lines = fbm(job.width, job.height, 2, job.texels(1.0), 3, 0.6F, job.random);
  Picture picture(job.width, job.height);
  for (int y = 0; y < job.height; ++y)
    for (int x = 0; x < job.width; ++x)
      picture(x, y) = to_rgb8(job.tone * (1.0F + 0.5F * job.variation * lines(x, y)));
  return picture;
}

}  // namespace mh
