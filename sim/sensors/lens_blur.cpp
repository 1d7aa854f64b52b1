// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <vector>

#include "sim/render/color.hpp"
#include "sim/sensors/blur_rows.hpp"
#include "sim/sensors/gaussian.hpp"
#include "sim/sensors/lens.hpp"

namespace mh {

void blur_by_lens(Grid2d<Rgb8>& color, double sigma_px) {
  if (sigma_px <= 0.0 || color.empty()) return;
  blur_rows(
      {color.width(), color.height(), 3}, gaussian_kernel(sigma_px),
      [&](int y, float* light) { decode_row(std::as_const(color).row(y), light); },
      [&](int y, const float* light) { encode_row(light, color.row(y)); });
}

}  // namespace mh
