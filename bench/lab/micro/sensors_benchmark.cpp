// SPDX-License-Identifier: Apache-2.0
// Cost of each sensor effect per 640x480 frame, compared with a plain render of the same view. The
// model house is seen without baked light from its living room, by a camera that turns at up to 1
// rad/s or is at rest.
// usage: sensors_benchmark (from the repository's folder)
#include <benchmark/benchmark.h>

#include <memory>

#include "scenes/load.hpp"
#include "sim/sensors/shutter.hpp"

namespace mh {
namespace {

constexpr std::size_t kFrame = 15;

std::shared_ptr<const Renderer> renderer() {
  static const std::shared_ptr<const Renderer> kRenderer =
      make_embree_renderer(load_scene("scenes/model_house/house.yaml"));
  return kRenderer;
}

Trajectory turning(double rad_per_s) {
  Eigen::Matrix3d level;  // looks along world x
  level << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Trajectory path;
  for (std::size_t i = 0; i <= 2 * kFrame; ++i) {
    const double heading = rad_per_s * static_cast<double>(i) / 30.0;
    path.push_back(
        {static_cast<Stamp>(i) * 33'333'333,
         SE3(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) * level, {1.7, 2.9, 1.11})});
  }
  return path;
}

void expose(benchmark::State& state, double rad_per_s, bool blur, bool rolling) {
  SensorConfig config = exact_sensors();
  config.motion_blur.enabled = blur;
  config.rolling_shutter.enabled = rolling;
  const Shutter shutter(renderer(), Camera{}, turning(rad_per_s), config);
  for (auto _ : state) benchmark::DoNotOptimize(shutter.expose(kFrame));
}
BENCHMARK_CAPTURE(expose, plain, 1.0, false, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(expose, both_at_rest, 0.0, true, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(expose, blur_quarter_rad_per_s, 0.25, true, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(expose, blur_1_rad_per_s, 1.0, true, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(expose, rolling_1_rad_per_s, 1.0, false, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(expose, both_quarter_rad_per_s, 0.25, true, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(expose, both_1_rad_per_s, 1.0, true, true)->Unit(benchmark::kMillisecond);

template <class Set>
void sensing(benchmark::State& state, Set set) {
  SensorConfig config = exact_sensors();
  set(config);
  const RenderedFrame seen =
      Shutter(renderer(), Camera{}, turning(1.0), exact_sensors()).expose(kFrame).seen;
  std::uint64_t seed = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(sense(seen, Camera{}, config, RandomStream(++seed), 0));
}
BENCHMARK_CAPTURE(sensing, nothing, [](SensorConfig&) {})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sensing, depth_noise, [](SensorConfig& c) {
  c.depth_noise.enabled = true;
})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sensing, depth_noise_with_shadow, [](SensorConfig& c) {
  c.depth_noise.enabled = c.depth_noise.projector_shadow = true;
})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sensing, gray_noise, [](SensorConfig& c) {
  c.color_noise.enabled = true;
})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sensing, shot_noise, [](SensorConfig& c) {
  c.shot_noise.enabled = true;
})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sensing, shot_noise_and_vignetting, [](SensorConfig& c) {
  c.shot_noise.enabled = c.vignetting.enabled = true;
})->Unit(benchmark::kMillisecond);

void labels(benchmark::State& state, LabelMode mode, const LabelNoiseConfig& noise) {
  SensorConfig config = exact_sensors();
  config.labels.noise = noise;
  const RenderedFrame seen =
      Shutter(renderer(), Camera{}, turning(1.0), exact_sensors()).expose(kFrame).seen;
  std::uint64_t seed = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(sense_labels(seen, mode, config, SE3(), RandomStream(++seed)));
}
BENCHMARK_CAPTURE(labels, exact, LabelMode::kExact, {})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(labels, boxes, LabelMode::kBoxes, {})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(labels, detector, LabelMode::kDetector, {})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(labels, exact_with_all_noise, LabelMode::kExact, {true, 0.1, 0.1, 0.1, 3})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mh

BENCHMARK_MAIN();
