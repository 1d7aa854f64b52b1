// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/lab/figure_tools.hpp"
#include "bench/lab/figures.hpp"

namespace mh {
namespace {

using namespace figure;

/// A wall that intersects the optical axis at a distance and leans back by an angle.
RenderedFrame leaning(double distance_m, double angle_rad) {
  RenderedFrame frame = blank(0.0F);
  for (int y = 0; y < kCamera.height_px; ++y) {
    const double b = (y - kCamera.cy_px) / kCamera.fy_px;
    const double z =
        distance_m * std::cos(angle_rad) / (std::cos(angle_rad) + b * std::sin(angle_rad));
    for (float& depth : frame.depth_m.row(y)) depth = z > 0.0 ? static_cast<float>(z) : 0.0F;
  }
  return frame;
}

/// A configuration without any depth faults: the caller switches on one at a time.
SensorConfig depth_only() {
  SensorConfig config;
  config.color_noise.enabled = false;
  config.depth_noise = no_depth_noise();
  return config;
}

/// Standard deviation of depth around the image center, where the wall is seen at the nominal
/// angle.
double axial_sigma(double distance_m, double angle_rad) {
  SensorConfig config = depth_only();
  config.depth_noise.axial = true;
  const RenderedFrame truth = leaning(distance_m, angle_rad);
  const RgbdFrame frame = sensed(truth, config);
  Spread spread;
  for (int y = 236; y < 244; ++y)
    for (int x = 220; x < 420; ++x) spread.add(frame.depth_m(x, y) - truth.depth_m(x, y));
  return spread.sigma();
}

/// Lateral standard deviation (px), computed from how often the last pixel before a wall's edge
/// misses the wall: the ray strays by more than half a pixel with probability erfc(0.5 / sigma /
/// sqrt 2) / 2. The wall is a fence around the image center, where it is seen at the nominal angle.
/// Each angle has its own random numbers.
double lateral_sigma(double angle_rad) {
  constexpr int kBoard = 8, kFirst = 256, kEnd = 384;  // px; boards and gaps of equal width
  SensorConfig config = depth_only();
  config.depth_noise.lateral = true;
  RenderedFrame truth = leaning(2.0, angle_rad);
  for (int y = 0; y < kCamera.height_px; ++y)
    for (int x = 0; x < kCamera.width_px; ++x)
      if (x < kFirst || x >= kEnd || x / kBoard % 2 != 0) truth.depth_m(x, y) = 0.0F;
  double missing = 0, edges = 0;
  const RandomStream own = RandomStream(1).fork(static_cast<std::uint64_t>(1e6 * angle_rad));
  for (std::uint64_t k = 0; k < 200; ++k) {
    const RgbdFrame frame = sense(truth, kCamera, config, own.fork(k), 0);
    for (int y = 215; y < 265; ++y)
      for (int x = kFirst + kBoard - 1; x < kEnd; x += 2 * kBoard, ++edges)
        missing += frame.depth_m(x, y) == 0.0F;
  }
  double low = 0.1, high = 5.0;
  while (high - low > 1e-4) {
    const double sigma = 0.5 * (low + high);
    const double expected = 0.5 * std::erfc(0.5 / sigma / std::numbers::sqrt2);
    (expected < missing / edges ? low : high) = sigma;
  }
  return low;
}

Plot axial_over_distance() {
  return {
      "Depth noise along the axis",
      "distance, m",
      "standard deviation, mm",
      {curve("Nguyen et al. 2012", 0.5, 5.0, [](double z) { return 1e3 * axial_sigma_m(z, 0.0); }),
       measured("measured", {0.6, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5},
                [](double z) { return 1e3 * axial_sigma(z, 0.0); })}};
}

Plot axial_over_angle() {
  return {"Depth noise on leaning walls, 2 m",
          "incidence, degrees",
          "standard deviation, mm",
          {curve("Nguyen et al. 2012", 0, 79,
                 [](double a) { return 1e3 * axial_sigma_m(2.0, a * kDegree); }),
           measured("measured", {0, 15, 30, 45, 55, 62, 68, 72, 75, 78},
                    [](double a) { return 1e3 * axial_sigma(2.0, a * kDegree); })}};
}

Plot lateral_over_angle() {
  return {
      "Ragged edges",
      "incidence, degrees",
      "standard deviation, px",
      {curve("Nguyen et al. 2012", 0, 79, [](double a) { return lateral_sigma_px(a * kDegree); }),
       measured("measured", {0, 20, 40, 55, 65, 70, 75, 78},
                [](double a) { return lateral_sigma(a * kDegree); })}};
}

Plot step_over_distance() {
  const auto step = [](double z) {
    SensorConfig config = depth_only();
    config.depth_noise.quantization = true;
    const RgbdFrame frame = sensed(leaning(z, 0.9), config);
    // The two depth values that bracket the distance.
    float below = 0.0F, above = 1e6F;
    for (const float depth : frame.depth_m) {
      if (depth < z) below = std::max(below, depth);
      if (depth >= z) above = std::min(above, depth);
    }
    return 1e3 * (above - below);
  };
  return {"Steps of depth",
          "distance, m",
          "step, mm",
          {curve("Khoshelham, Elberink 2012", 0.6, 5.0,
                 [](double z) { return 1e3 * z * z / (kCamera.fx_px * kCamera.baseline_m * 8.0); }),
           measured("measured", {0.8, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5}, step)}};
}

Plot holes_over_angle() {
  const auto holes = [](double a) {
    SensorConfig config = depth_only();
    config.depth_noise.grazing_holes = true;
    const RgbdFrame frame = sensed(leaning(2.0, a * kDegree), config);
    double missing = 0;
    for (int y = 236; y < 244; ++y)
      for (int x = 300; x < 340; ++x) missing += frame.depth_m(x, y) == 0.0F;
    return 100.0 * missing / 320.0;
  };
  return {"Holes at grazing angles",
          "incidence, degrees",
          "pixels without return, %",
          {curve("Nguyen et al. 2012: no more", 60, 88,
                 [](double a) { return a * kDegree > kMaxIncidenceRad ? 100.0 : 0.0; }),
           measured("measured", {60, 65, 70, 74, 77, 79, 81, 83, 86, 88}, holes)}};
}

Plot shadow_over_distance() {
  const auto width = [](double z) {
    SensorConfig config = depth_only();
    config.depth_noise.projector_shadow = true;
    RenderedFrame truth = blank(4.0F);
    for (int y = 0; y < kCamera.height_px; ++y)
      for (int x = 300; x < 500; ++x) truth.depth_m(x, y) = static_cast<float>(z);
    const RgbdFrame frame = sensed(truth, config);
    double missing = 0;
    for (const float depth : frame.depth_m.row(100)) missing += depth == 0.0F;
    return missing;
  };
  return {"Shadow before a wall at 4 m",
          "distance of what throws it, m",
          "width, px",
          {curve("f b (1/z - 1/4 m)", 0.6, 3.9,
                 [](double z) { return kCamera.fx_px * kCamera.baseline_m * (1 / z - 0.25); }),
           measured("measured", {0.6, 0.8, 1, 1.4, 2, 2.6, 3.2, 3.8}, width)}};
}

}  // namespace

std::vector<Plot> depth_figures() {
  return {axial_over_distance(), axial_over_angle(), lateral_over_angle(),
          step_over_distance(),  holes_over_angle(), shadow_over_distance()};
}

}  // namespace mh
