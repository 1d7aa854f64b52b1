// SPDX-License-Identifier: Apache-2.0
#include "bench/sensors/figures.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "sim/render/colour.hpp"
#include "sim/sensors/lens.hpp"
#include "sim/sensors/shutter.hpp"

namespace mh {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
const Camera kCamera;

/// The points of a function over a range.
Series curve(const std::string& name, double from, double to,
             const std::function<double(double)>& y) {
  Series series{name, false, {}};
  constexpr int kSteps = 80;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = from + (to - from) * i / kSteps;
    series.points.emplace_back(x, y(x));
  }
  return series;
}

Series measured(const std::string& name, const std::vector<double>& at,
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

RenderedFrame blank(float depth_m, std::uint8_t grey = 128) {
  const int w = kCamera.width_px, h = kCamera.height_px;
  return {{w, h, {grey, grey, grey}}, {w, h, depth_m}, {w, h}, {w, h}};
}

/// A wall that cuts the axis at a distance and leans back by an angle.
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

/// Depth faults one at a time: everything off but what the caller switches on.
SensorConfig depth_only() {
  SensorConfig config;
  config.colour_noise_on = false;
  config.depth_noise = {.axial = false,
                        .lateral = false,
                        .quantisation = false,
                        .grazing_holes = false,
                        .projector_shadow = false,
                        .min_range_m = 0.0,
                        .max_range_m = 1e6};
  return config;
}

SensorConfig clean() {
  SensorConfig config;
  config.depth_noise_on = config.colour_noise_on = false;
  return config;
}

RgbdFrame sensed(const RenderedFrame& truth, const SensorConfig& config, double gain = 1.0) {
  return sense(truth, kCamera, config, RandomStream(1), 0, gain);
}

/// Around the middle of the picture, where an angle is what it is said to be.
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

/// By how much the edge of a wall reaches over: the mean overreach of a normal stray is
/// sigma / sqrt(2 pi).
double lateral_sigma(double angle_rad) {
  SensorConfig config = depth_only();
  config.depth_noise.lateral = true;
  RenderedFrame truth = leaning(2.0, angle_rad);
  for (int y = 0; y < kCamera.height_px; ++y)
    for (int x = 320; x < kCamera.width_px; ++x) truth.depth_m(x, y) = 0.0F;
  const RgbdFrame frame = sensed(truth, config);
  int missing = 0, rows = 0;
  for (int y = 215; y < 265; ++y, ++rows)
    for (int x = 300; x < 320; ++x) missing += frame.depth_m(x, y) == 0.0F;
  return missing * std::sqrt(2.0 * std::numbers::pi) / rows;
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
    config.depth_noise.quantisation = true;
    const RgbdFrame frame = sensed(leaning(z, 0.9), config);
    // The two values that enclose the distance.
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
          {curve("Nguyen et al. 2012: none measured beyond 80 deg", 60, 88,
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
          {curve("f b (1/z - 1/4 m), Khoshelham, Elberink 2012", 0.6, 3.9,
                 [](double z) { return kCamera.fx_px * kCamera.baseline_m * (1 / z - 0.25); }),
           measured("measured", {0.6, 0.8, 1, 1.4, 2, 2.6, 3.2, 3.8}, width)}};
}

/// A wall 2 m away, white left of world x = 0 and black right of it.
class Edge : public Renderer {
 public:
  static constexpr double kDepthM = 2.0;
  RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const override {
    const int w = camera.width_px, h = camera.height_px;
    RenderedFrame frame{{w, h}, {w, h, static_cast<float>(kDepthM)}, {w, h, 1}, {w, h, 1}};
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        const Eigen::Vector3d p = world_from_camera * camera.unproject(x, y, kDepthM);
        const std::uint8_t grey =
            linear_to_srgb(static_cast<float>(0.5 - p.x() / kDepthM * camera.fx_px));
        frame.colour(x, y) = {grey, grey, grey};
      }
    return frame;
  }
};

Camera narrow_camera() {
  Camera camera;
  camera.width_px = 120, camera.height_px = 90;
  camera.cx_px = 59.5, camera.cy_px = 44.5;
  return camera;
}

Grid2d<Rgb8> passing_the_edge(double speed_m_per_s, const SensorConfig& config, double from_m) {
  Trajectory path;
  for (int i = -2; i <= 2; ++i)
    path.push_back(
        {(i + 2) * Stamp{33'333'333},
         SE3(Eigen::Matrix3d::Identity(), {from_m + speed_m_per_s * i * 0.033333333, 0, 0})});
  return Shutter(std::make_shared<Edge>(), narrow_camera(), path, config).expose(2).seen.colour;
}

/// The width over which the edge is smeared, from the variance of its slope; where the edge falls
/// between pixels is averaged out (see tests/sim/sensors/shutter_test.cpp).
double smear_px(double speed_m_per_s, double exposure_s) {
  SensorConfig config = clean();
  config.shutter.motion_blur_on = true;
  config.shutter.exposure_s = exposure_s;
  constexpr int kPlaces = 8;
  double squared = 0.0;
  for (int k = 0; k < kPlaces; ++k) {
    const double from_m = Edge::kDepthM / kCamera.fx_px * k / kPlaces;
    const Grid2d<Rgb8> colour = passing_the_edge(speed_m_per_s, config, from_m);
    double mean = 0.0, square = 0.0;
    for (int x = 0; x + 1 < colour.width(); ++x) {
      const double drop = srgb_to_linear(colour(x, 45).r) - srgb_to_linear(colour(x + 1, 45).r);
      mean += drop * x;
      square += drop * x * x;
    }
    squared += (12.0 * (square - mean * mean) - 2.0) / kPlaces;
  }
  return std::sqrt(std::max(0.0, squared));
}

Plot blur_over_speed() {
  Plot plot{"Motion blur, 2 m away", "speed, m/s", "length, px", {}};
  for (const double exposure_ms : {10.0, 20.0, 33.0}) {
    const double exposure_s = 1e-3 * exposure_ms;
    plot.series.push_back(
        curve("f v t / z, t = " + std::to_string(static_cast<int>(exposure_ms)) + " ms", 0, 2,
              [=](double v) { return kCamera.fx_px * v * exposure_s / Edge::kDepthM; }));
    plot.series.push_back(measured("measured", {0, 0.35, 0.55, 1, 1.5, 2},
                                   [=](double v) { return smear_px(v, exposure_s); }));
  }
  return plot;
}

Plot slant_over_speed() {
  const auto slant = [](double v) {
    SensorConfig config = clean();
    config.shutter.rolling_shutter_on = true;
    const Grid2d<Rgb8> colour = passing_the_edge(v, config, 0.0);
    const auto edge = [&](int y) {
      double light = 0.0;
      for (const Rgb8& c : colour.row(y)) light += srgb_to_linear(c.r);
      return light;
    };
    return (edge(0) - edge(colour.height() - 1)) * 90.0 / 89.0;
  };
  return {"Rolling shutter, 2 m away",
          "speed, m/s",
          "slant of an upright edge, px",
          {curve("f v 26.1 ms / z, Ringaby, Forssen 2011", 0, 3,
                 [](double v) { return kCamera.fx_px * v * 0.0261 / Edge::kDepthM; }),
           measured("measured", {0, 0.5, 1, 1.5, 2, 2.5, 3}, slant)}};
}

Plot noise_over_light() {
  Plot plot{"Shot and read noise", "linear light, share of white", "signal to noise, dB", {}};
  for (const double gain : {1.0, 8.0}) {
    const auto published = [=](double light) {
      const double electrons = light * 3981.0 / gain;
      return 20.0 * std::log10(electrons / std::sqrt(electrons + 1.6 * 1.6));
    };
    const auto seen = [=](double light) {
      SensorConfig config = clean();
      config.shot_noise_on = true;
      config.shot_noise.gain = gain;
      const std::uint8_t grey = linear_to_srgb(static_cast<float>(light));
      Spread spread;
      for (const Rgb8& c : sensed(blank(2.0F, grey), config).colour)
        spread.add(srgb_to_linear(c.g));
      return 20.0 * std::log10(spread.sum / spread.n / spread.sigma());
    };
    const std::string name = gain == 1.0 ? "OV5640: 36 dB at white" : "the same, 8 x gain";
    plot.series.push_back(curve(name, 0.01, 1.0, published));
    plot.series.push_back(measured("measured", {0.02, 0.05, 0.1, 0.18, 0.3, 0.45, 0.6}, seen));
  }
  return plot;
}

Plot fall_off_over_angle() {
  const auto share = [](double a) {
    SensorConfig config = clean();
    config.vignetting_on = true;
    const auto x = static_cast<int>(
        std::lround(kCamera.cx_px + kCamera.fx_px * std::tan(a * kDegree) / std::numbers::sqrt2));
    const auto y = static_cast<int>(
        std::lround(kCamera.cy_px + kCamera.fy_px * std::tan(a * kDegree) / std::numbers::sqrt2));
    const RgbdFrame frame = sensed(blank(2.0F, 230), config);
    return srgb_to_linear(frame.colour(std::min(x, 639), std::min(y, 479)).g) /
           srgb_to_linear(std::uint8_t{230});
  };
  return {"Vignetting",
          "angle from the axis, degrees",
          "light",
          {curve("cos^4", 0, 31, [](double a) { return std::pow(std::cos(a * kDegree), 4); }),
           measured("measured", {0, 5, 10, 15, 20, 25, 30}, share)}};
}

}  // namespace

std::vector<Plot> sensor_figures() {
  return {axial_over_distance(), axial_over_angle(),     lateral_over_angle(), step_over_distance(),
          holes_over_angle(),    shadow_over_distance(), blur_over_speed(),    slant_over_speed(),
          noise_over_light(),    fall_off_over_angle()};
}

}  // namespace mh
