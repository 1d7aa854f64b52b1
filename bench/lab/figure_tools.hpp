// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "bench/report/drawing/plot.hpp"
#include "sim/sensors/sense.hpp"
#include "slam/core/angles.hpp"

// Helpers that the figures of the sensor models share.
namespace mh::figure {

inline const Camera kCamera;

/// The points of a function over a range.
inline Series curve(const std::string& name, double from, double to,
                    const std::function<double(double)>& y) {
  Series series{name, false, {}};
  constexpr int kSteps = 80;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = from + (to - from) * i / kSteps;
    series.points.emplace_back(x, y(x));
  }
  return series;
}

inline Series measured(const std::string& name, const std::vector<double>& at,
                       const std::function<double(double)>& y) {
  Series series{name, true, {}};
  for (const double x : at) series.points.emplace_back(x, y(x));
  return series;
}

struct Spread {
  double n = 0, sum = 0, square = 0;
  void add(double x) { n += 1, sum += x, square += x * x; }
  double sigma() const { return std::sqrt(std::max(0.0, square / n - sum / n * (sum / n))); }
};

inline RenderedFrame blank(float depth_m, std::uint8_t gray = 128) {
  const int w = kCamera.width_px, h = kCamera.height_px;
  return {{w, h, {gray, gray, gray}}, {w, h, depth_m}, {w, h}, {w, h}};
}

inline RgbdFrame sensed(const RenderedFrame& truth, const SensorConfig& config, double gain = 1.0) {
  return sense(truth, kCamera, config, RandomStream(1), 0, gain);
}

}  // namespace mh::figure
