// SPDX-License-Identifier: Apache-2.0
// Cost of a frame at a sensor level, stage by stage, as a ratio to a plain textured render of the
// same view. Figures are medians over frames spread along a motion, by the thread's CPU clock. The
// limits are those of docs/measurements/cost_of_the_bench.md.
// Usage: frame_benchmark SCENE MOTION ROBOT LEVEL [frames]
#include <malloc.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/lab/micro/timing.hpp"
#include "sim/sensors/depth_noise.hpp"
#include "sim/sensors/develop.hpp"
#include "sim/sensors/shutter.hpp"
#include "sim/simulation/lit_scene.hpp"
#include "sim/simulation/travel.hpp"

namespace mh {
namespace {

struct Stage {
  std::string name;
  std::function<void(std::size_t frame)> work;
  std::vector<double> spent_ms = {};

  double median() const { return mh::median(spent_ms); }
  double mean() const {
    double sum = 0;
    for (const double ms : spent_ms) sum += ms;
    return sum / static_cast<double>(spent_ms.size());
  }
};

int run(const std::vector<std::string>& given) {
  const std::size_t frames = given.size() > 4 ? std::stoul(given[4]) : 40;
  const Robot robot = load_robot(given[2]);
  const SensorConfig sensors = load_sensor_config(given[3]);
  const Scene scene = load_lit_scene(given[0], 2);
  const Trajectory path = travel(scene, robot, given[1]).camera;
  const auto plain =
      make_embree_renderer(scene, {.exposure = 1.0F, .antialiasing = Antialiasing::kNone});
  const std::shared_ptr<const Renderer> renderer = make_scene_renderer(scene);
  const Shutter shutter(renderer, robot.camera, path, sensors);
  const Camera& camera = shutter.camera();
  Shutter::Exposed exposed = shutter.expose(0);
  RgbdFrame frame;
  const RandomStream noise(1);
  std::vector<Stage> stages = {
      {"plain textured render",
       [&](std::size_t i) { plain->render(camera, path[i].world_from_camera); }},
      {"the same, edges smoothed",
       [&](std::size_t i) { renderer->render(camera, path[i].world_from_camera); }},
      {"exposure", [&](std::size_t i) { exposed = shutter.expose(i); }},
      {"frame from it",
       [&](std::size_t i) {
         frame = sense(exposed.seen, camera, sensors, noise.fork(i), 0, exposed.gain);
       }},
      {"  of this, depth",
       [&](std::size_t i) {
         frame.depth_m =
             noisy_depth(exposed.seen.depth_m, camera, sensors.depth_noise, noise.fork(i));
       }},
      {"  of this, color",
       [&](std::size_t i) {
         frame.color = exposed.seen.color;
         develop(frame.color, camera, sensors, exposed.gain, noise.fork(i));
       }},
      {"labels", [&](std::size_t i) {
         sense_labels(exposed.seen, LabelMode::kExact, sensors, path[i].world_from_camera, noise);
       }}};
  for (std::size_t k = 0; k < frames; ++k)
    for (Stage& stage : stages) {
      const double begin_ms = thread_ms();
      stage.work((2 * k + 1) * path.size() / (2 * frames));
      stage.spent_ms.push_back(thread_ms() - begin_ms);
    }
  fmt::print("{} frames of {}\n{:<34} {:>10} {:>10}\n", frames, path.size(), "ms", "median",
             "mean");
  for (const Stage& stage : stages)
    fmt::print("{:<34} {:10.2f} {:10.2f}\n", stage.name, stage.median(), stage.mean());
  const double whole_ms = stages[2].mean() + stages[3].mean();
  fmt::print("exposure and frame : plain textured render   {:.2f}   (at most 6)\n",
             whole_ms / stages[0].mean());
  return 0;
}

}  // namespace
}  // namespace mh

int main(int argc, char** argv) {
  mallopt(M_MMAP_THRESHOLD, 64 << 20);
  mallopt(M_TRIM_THRESHOLD, 512 << 20);
  const std::vector<std::string> given(argv + 1, argv + argc);
  if (given.size() < 4 || given.size() > 5) {
    fmt::print(stderr, "usage: frame_benchmark SCENE MOTION ROBOT LEVEL [frames]\n");
    return 2;
  }
  try {
    return mh::run(given);
  } catch (const std::exception& error) {
    fmt::print(stderr, "frame_benchmark: {}\n", error.what());
    return 2;
  }
}
