// SPDX-License-Identifier: Apache-2.0
// Cost of writing a rendered sequence: each stage alone on the same threads, then all stages
// together. Prints wall time and CPU time of all threads, and the memory of the process.
// Usage: sequence_benchmark SCENE MOTION ROBOT LEVEL OUT [frames]
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core/utility.hpp>

#include "bench/lab/micro/timing.hpp"
#include "sim/render/parallel.hpp"
#include "sim/simulation/lit_scene.hpp"
#include "sim/simulation/render_sequence.hpp"
#include "sim/simulation/travel.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr int kThreads = 2;
constexpr std::size_t kHeldFrames = 16;  // frames that are repeatedly encoded and written

/// Frames per second of wall time (wall_hz), and per second of CPU time of one thread (work_hz).
struct Speed {
  double wall_hz, work_hz;
};

double seconds(clockid_t clock) {
  return 1e-3 * clock_ms(clock);
}

template <class Work>
Speed measure(const char* stage, std::size_t frames, const Work& work) {
  const double wall_s = seconds(CLOCK_MONOTONIC), work_s = seconds(CLOCK_PROCESS_CPUTIME_ID);
  work();
  const auto count = static_cast<double>(frames);
  const Speed speed{count / (seconds(CLOCK_MONOTONIC) - wall_s),
                    kThreads * count / (seconds(CLOCK_PROCESS_CPUTIME_ID) - work_s)};
  std::array<double, 1> load{};
  getloadavg(load.data(), 1);
  fmt::print("{:<34} {:8.1f} {:8.1f}   {:4.1f}\n", stage, speed.wall_hz, speed.work_hz, load[0]);
  std::fflush(stdout);
  return speed;
}

template <class Work>
void for_frames(std::size_t frames, const Work& work) {
  parallel_for(static_cast<int>(frames), kThreads,
               [&](int k) { work(static_cast<std::size_t>(k)); });
}

double resident_mb() {
  std::size_t total = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> total >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) * 1e-6;
}

int run(const std::vector<std::string>& given) {
  const fs::path out = given[4];
  RenderSequenceOptions options{.frames = given.size() > 5 ? std::stoul(given[5]) : 1000,
                                .threads = kThreads};
  if (fs::exists(out)) throw InputError(fmt::format("{}: already exists", out.string()));
  const Robot robot = load_robot(given[2]);
  const SensorConfig sensors = load_sensor_config(given[3]);
  const Scene scene = load_lit_scene(given[0], kThreads);
  const Shutter shutter(make_scene_renderer(scene, "embree"), robot.camera,
                        travel(scene, robot, given[1]).camera, sensors);
  const std::size_t frames = std::min(options.frames, shutter.path().size());

  std::vector<ExactFrame> held;
  for (std::size_t k = 0; k < kHeldFrames; ++k)
    held.push_back(exact_frame(shutter, sensors, options, k * frames / kHeldFrames));

  fmt::print("{} frames, {} threads\n", frames, kThreads);
  fmt::print("{:<34} {:>8} {:>8}   {}\n", "frames per second", "wall", "work", "load");
  const Speed render = measure("rendering and sensors alone", frames, [&] {
    for_frames(frames, [&](std::size_t k) { exact_frame(shutter, sensors, options, k); });
  });
  const fs::path memory = fmt::format("/dev/shm/modelhouse_{}", getpid());
  const auto in_memory = make_sequence_writer("tum", memory, robot.camera);
  const Speed encode = measure("encoding alone (kept in memory)", frames, [&] {
    for_frames(frames, [&](std::size_t k) {
      const ExactFrame& frame = held[k % kHeldFrames];
      in_memory->add(k % kHeldFrames, frame);
    });
  });
  std::vector<std::pair<fs::path, std::string>> files;  // encoded files of the held frames
  for (const auto& entry : fs::recursive_directory_iterator(memory))
    if (entry.is_regular_file())
      files.emplace_back(fs::relative(entry.path(), memory), read_file(entry.path()));
  fs::remove_all(memory);
  const Speed write = measure("writing alone (encoded before)", frames, [&] {
    for (const auto& [file, bytes] : files) fs::create_directories((out / file).parent_path());
    for_frames(frames, [&](std::size_t k) {
      for (std::size_t i = k % kHeldFrames; i < files.size(); i += kHeldFrames)
        write_atomically(out / files[i].first.parent_path() /
                             fmt::format("{}_{}.png", k, files[i].first.stem().string()),
                         files[i].second);
    });
  });
  fs::remove_all(out);

  const auto writer = make_sequence_writer("tum", out, robot.camera);
  std::vector<std::string> memory_lines;
  std::size_t done = 0;
  const Speed whole = measure("all of it", frames, [&] {
    render_sequence(shutter, sensors, *writer, options, [&](double) {
      if (++done == frames / 10 || done == frames / 2 || done == frames)
        memory_lines.push_back(fmt::format("{:.0f} MB after {} frames", resident_mb(), done));
    });
  });
  const auto slowest = [&](double Speed::*clock) {
    return std::min({render.*clock, encode.*clock, write.*clock});
  };
  fmt::print("all of it : the slowest stage alone  {:.2f} by the wall, {:.2f} by work\n",
             whole.wall_hz / slowest(&Speed::wall_hz), whole.work_hz / slowest(&Speed::work_hz));
  for (const std::string& line : memory_lines) fmt::print("{}\n", line);
  return 0;
}

}  // namespace
}  // namespace mh

int main(int argc, char** argv) {
  const std::vector<std::string> given(argv + 1, argv + argc);
  if (given.size() < 5 || given.size() > 6) {
    fmt::print(stderr, "usage: sequence_benchmark SCENE MOTION ROBOT LEVEL OUT [frames]\n");
    return 2;
  }
  cv::setNumThreads(1);  // as `modelhouse` does
  try {
    return mh::run(given);
  } catch (const std::exception& error) {
    fmt::print(stderr, "sequence_benchmark: {}\n", error.what());
    return 2;
  }
}
