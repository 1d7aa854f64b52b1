// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/lab/figure_tools.hpp"
#include "bench/lab/figures.hpp"
#include "sim/render/color.hpp"
#include "sim/sensors/lens.hpp"
#include "sim/sensors/shutter.hpp"

namespace mh {
namespace {

using namespace figure;

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
        const std::uint8_t gray =
            linear_to_srgb(static_cast<float>(0.5 - p.x() / kDepthM * camera.fx_px));
        frame.color(x, y) = {gray, gray, gray};
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
  return Shutter(std::make_shared<Edge>(), narrow_camera(), path, config).expose(2).seen.color;
}

/// The width of a smeared edge, computed from the variance of its slope. The edge's subpixel
/// position is averaged out (see tests/sim/sensors/shutter_test.cpp).
double smear_px(double speed_m_per_s, double exposure_ms) {
  SensorConfig config = exact_sensors();
  config.motion_blur = {.enabled = true, .exposure_ms = exposure_ms};
  constexpr int kPlaces = 8;
  double squared = 0.0;
  for (int k = 0; k < kPlaces; ++k) {
    const double from_m = Edge::kDepthM / kCamera.fx_px * k / kPlaces;
    const Grid2d<Rgb8> color = passing_the_edge(speed_m_per_s, config, from_m);
    double mean = 0.0, square = 0.0;
    for (int x = 0; x + 1 < color.width(); ++x) {
      const double drop = srgb_to_linear(color(x, 45).r) - srgb_to_linear(color(x + 1, 45).r);
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
                                   [=](double v) { return smear_px(v, exposure_ms); }));
  }
  return plot;
}

Plot slant_over_speed() {
  const auto slant = [](double v) {
    SensorConfig config = exact_sensors();
    config.rolling_shutter.enabled = true;
    const Grid2d<Rgb8> color = passing_the_edge(v, config, 0.0);
    const auto edge = [&](int y) {
      double light = 0.0;
      for (const Rgb8& c : color.row(y)) light += srgb_to_linear(c.r);
      return light;
    };
    return (edge(0) - edge(color.height() - 1)) * 90.0 / 89.0;
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
      SensorConfig config = exact_sensors();
      config.shot_noise.enabled = true;
      config.shot_noise.gain = gain;
      const std::uint8_t gray = linear_to_srgb(static_cast<float>(light));
      Spread spread;
      for (const Rgb8& c : sensed(blank(2.0F, gray), config).color) spread.add(srgb_to_linear(c.g));
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
    SensorConfig config = exact_sensors();
    config.vignetting.enabled = true;
    const auto x = static_cast<int>(
        std::lround(kCamera.cx_px + kCamera.fx_px * std::tan(a * kDegree) / std::numbers::sqrt2));
    const auto y = static_cast<int>(
        std::lround(kCamera.cy_px + kCamera.fy_px * std::tan(a * kDegree) / std::numbers::sqrt2));
    const RgbdFrame frame = sensed(blank(2.0F, 230), config);
    return srgb_to_linear(frame.color(std::min(x, 639), std::min(y, 479)).g) /
           srgb_to_linear(std::uint8_t{230});
  };
  return {"Vignetting",
          "angle from the axis, degrees",
          "light",
          {curve("cos^4", 0, 31, [](double a) { return std::pow(std::cos(a * kDegree), 4); }),
           measured("measured", {0, 5, 10, 15, 20, 25, 30}, share)}};
}

/// A gray wall that becomes three times as bright once the camera has passed x = 0.
class Lamp : public Renderer {
 public:
  RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const override {
    const int w = camera.width_px, h = camera.height_px;
    const std::uint8_t gray = linear_to_srgb(world_from_camera.translation().x() < 0 ? 0.1F : 0.3F);
    return {{w, h, {gray, gray, gray}}, {w, h, 2.0F}, {w, h, 1}, {w, h, 1}};
  }
};

Plot gain_over_time() {
  SensorConfig config = exact_sensors();
  config.auto_exposure.enabled = true;
  constexpr int kFrames = 75, kBright = 15;
  Trajectory path;
  for (int i = 0; i < kFrames; ++i)
    path.push_back(
        {i * Stamp{33'333'333}, SE3(Eigen::Matrix3d::Identity(), {i - kBright + 0.5, 0, 0})});
  const Shutter shutter(std::make_shared<Lamp>(), narrow_camera(), path, config);
  const double tau_s = config.auto_exposure.time_constant_s;
  Series gains{"measured", true, {}};
  for (int i = 0; i < kFrames; i += 3)
    gains.points.emplace_back((i - kBright) / 30.0,
                              shutter.expose(static_cast<std::size_t>(i)).gain);
  return {"Exposure control, light times 3 at 0 s",
          "time, s",
          "gain",
          {curve("0.6 * 3^exp(-t / 0.5 s)", -0.5, 2.0,
                 [=](double t) {
                   return t < 0 ? 1.8 : 0.6 * std::pow(3.0, std::exp(-(t + 1.0 / 30.0) / tau_s));
                 }),
           gains}};
}

Plot distortion_over_radius() {
  Camera camera;
  camera.distortion = {-0.05452, 0.06920, 0.0, 0.0, 0.0};
  const Lens lens(camera);
  RenderedFrame ramp{{lens.pinhole().width_px, lens.pinhole().height_px},
                     {lens.pinhole().width_px, lens.pinhole().height_px},
                     {lens.pinhole().width_px, lens.pinhole().height_px},
                     {lens.pinhole().width_px, lens.pinhole().height_px}};
  for (int y = 0; y < ramp.depth_m.height(); ++y)
    for (int x = 0; x < ramp.depth_m.width(); ++x)
      ramp.depth_m(x, y) = static_cast<float>(lens.pinhole().unproject(x, y, 1.0).x());
  const RenderedFrame bent = lens.bend(ramp);
  const auto shift = [&](double px) {
    const int x = static_cast<int>(std::lround(camera.cx_px + px));
    return x - (camera.cx_px + camera.fx_px * bent.depth_m(x, 240));
  };
  return {"Lens of Pepper's upper camera",
          "distance from the middle, px",
          "shift, px (nearest pixel)",
          {curve("k1, k2 of naoqi_driver", 0, 315,
                 [&](double px) {
                   const double x = px / camera.fx_px, r2 = x * x;
                   return camera.fx_px * x * r2 *
                          (camera.distortion.k1 + camera.distortion.k2 * r2);
                 }),
           measured("measured", {0.5, 50.5, 100.5, 150.5, 200.5, 250.5, 300.5}, shift)}};
}

}  // namespace

std::vector<Plot> light_figures() {
  return {blur_over_speed(),     slant_over_speed(), noise_over_light(),
          fall_off_over_angle(), gain_over_time(),   distortion_over_radius()};
}

}  // namespace mh
