// SPDX-License-Identifier: Apache-2.0
// simulation_benchmark SCENE ROBOT LEVEL [SECONDS [TICKS_PER_FRAME]]: how much faster than real
// time a robot is simulated on one core, with physics, lasers, sonars, odometry and camera frames,
// while it turns and drives. Prints the share of each in the CPU time, and whether a second run
// gave the same bits.

#include <cstdlib>
#include <memory>

#include <fmt/format.h>
#include <opencv2/core/utility.hpp>

#include "bench/lab/micro/timing.hpp"
#include "bench/protocol/world/cached_light.hpp"
#include "bench/suite/cache.hpp"
#include "scenes/load.hpp"
#include "sim/motion/floor_grid.hpp"
#include "sim/simulation/lit_scene.hpp"
#include "sim/simulation/simulation.hpp"
#include "slam/core/digest.hpp"

namespace {

using namespace mh;

double processor_s() {
  return 1e-3 * clock_ms(CLOCK_PROCESS_CPUTIME_ID);
}

struct Drive {
  double cpu_s = 0, setup_s = 0, simulated_s = 0;
  int frames = 0;
  std::uint64_t digest = 0;
};

Drive drive_about(const SimulatedScene& scene, const Robot& robot, const SensorConfig& level,
                  const SimulationConfig& config, double seconds) {
  Drive drive;
  const double begun_s = processor_s();
  Simulation simulation(scene, robot, level, config);
  drive.setup_s = processor_s() - begun_s;
  const double start_s = processor_s();
  while (simulation.time_s() < seconds) {
    // Turns, and drives a little back and forth.
    const bool forward = static_cast<int>(simulation.time_s() / 2) % 2 == 0;
    const RobotObservation seen = simulation.step({forward ? 0.15 : -0.15, 0, 0.5}, 0.1);
    if (seen.frame) {
      ++drive.frames;
      drive.digest = chained(drive.digest, digest(*seen.frame));
    }
    for (const auto& ranges_m : seen.reading.lasers_m)
      drive.digest = digest_bytes(ranges_m.data(), ranges_m.size() * sizeof(float), drive.digest);
  }
  drive.cpu_s = processor_s() - start_s;
  drive.simulated_s = simulation.time_s();
  return drive;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    fmt::print(stderr,
               "usage: simulation_benchmark SCENE ROBOT LEVEL [SECONDS [TICKS_PER_FRAME]]\n");
    return 2;
  }
  cv::setNumThreads(1);
  const double seconds = argc > 4 ? std::atof(argv[4]) : 30;
  Scene scene = load_scene(argv[1]);
  light_from_cache(scene, 2, Cache(Cache::default_folder()));
  const Robot robot = load_robot(argv[2]);
  const SensorConfig level = load_sensor_config(argv[3]);
  SimulatedScene place{std::make_shared<const Scene>(scene), make_scene_renderer(scene)};
  SimulationConfig config{.ticks_per_frame = argc > 5 ? std::atoi(argv[5]) : 3};
  // Start at the place with the most free space around it.
  const FloorGrid grid = make_floor_grid(scene, {.top_m = robot.height_m});
  float best_m = 0;
  for (int y = 0; y < grid.clearance_m.height(); ++y)
    for (int x = 0; x < grid.clearance_m.width(); ++x)
      if (grid.clearance_m(x, y) > best_m) {
        best_m = grid.clearance_m(x, y);
        config.start_m = grid.center_of({x, y});
      }
  const Drive all = drive_about(place, robot, level, config, seconds);
  const Drive again = drive_about(place, robot, level, config, seconds);
  config.ticks_per_frame = 1 << 30;
  const Drive blind = drive_about(place, robot, level, config, seconds);
  const double frame_ms = 1e3 * (all.cpu_s - blind.cpu_s) / std::max(1, all.frames);
  fmt::print(
      "{}: {:.1f} s simulated in {:.2f} s on one core: {:.2f} times real time\n"
      "  {} frames at {:.1f} ms; physics, lasers, sonars and odometry {:.1f} ms per simulated "
      "second\n  {:.2f} s to set up; second run: {}\n",
      scene.name, all.simulated_s, all.cpu_s, all.simulated_s / all.cpu_s, all.frames, frame_ms,
      1e3 * blind.cpu_s / blind.simulated_s, all.setup_s,
      all.digest == again.digest ? "the same bits" : "OTHER BITS");
  return all.digest == again.digest ? 0 : 1;
}
