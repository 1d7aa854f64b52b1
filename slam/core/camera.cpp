// SPDX-License-Identifier: Apache-2.0
#include "slam/core/camera.hpp"

#include <cmath>

#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace mh {

void validate(const Camera& camera) {
  const auto require = [](bool good, const char* field, double value) {
    if (!good || !std::isfinite(value))
      throw InputError(fmt::format("camera: {} = {} is out of range", field, value));
  };
  require(camera.width_px > 0, "width_px", camera.width_px);
  require(camera.height_px > 0, "height_px", camera.height_px);
  // A pinhole that sees less than 174 degrees and more than three arc minutes.
  const auto is_focal = [&](double f) {
    return f > 0.05 * camera.width_px / 2 && f < 1e3 * camera.width_px;
  };
  require(is_focal(camera.fx_px), "fx_px", camera.fx_px);
  require(is_focal(camera.fy_px), "fy_px", camera.fy_px);
  require(camera.cx_px >= 0 && camera.cx_px <= camera.width_px - 1, "cx_px", camera.cx_px);
  require(camera.cy_px >= 0 && camera.cy_px <= camera.height_px - 1, "cy_px", camera.cy_px);
  require(camera.rate_hz > 0, "rate_hz", camera.rate_hz);
  require(camera.baseline_m > 0, "baseline_m", camera.baseline_m);
  require(camera.disparity_sigma_px > 0, "disparity_sigma_px", camera.disparity_sigma_px);
}

}  // namespace mh
