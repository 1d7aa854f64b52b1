// SPDX-License-Identifier: Apache-2.0
// Ratios of rendering times at 640x480: medians over interleaved repeats of twelve views, with the
// limits stated in docs/measurements/rendering.md. Single-threaded work is timed by its thread's
// CPU clock, which does not depend on the machine's load. Our renderer and OSMesa on two threads
// are judged by wall time, since that is how long a user waits. Use quiet machines only (the load
// is printed). The CPU time of all their threads is also printed. Usage: render_ratios [--portable]
// [repeats]
#include <malloc.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "bench/lab/micro/render_benchmark_room.hpp"
#include "bench/lab/micro/timing.hpp"
#include "sim/render/packet.hpp"
#include "sim/render/renderer.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

/// Cost of an image, by three clocks.
struct Cost {
  double thread_ms = 0;   // CPU time of the calling thread
  double process_ms = 0;  // CPU time of all threads
  double wall_ms = 0;

  static Cost now() {
    return {mh::thread_ms(), clock_ms(CLOCK_PROCESS_CPUTIME_ID), clock_ms(CLOCK_MONOTONIC)};
  }
  Cost since(const Cost& begin) const {
    return {thread_ms - begin.thread_ms, process_ms - begin.process_ms, wall_ms - begin.wall_ms};
  }
};

/// Traces only the rays of a whole image, in the renderer's order.
class RayTracer {
 public:
  RayTracer(const Scene& scene, bool portable) : bvh_(scene, 2, portable), packets_(64) {}

  void trace(const Camera& camera, const SE3& pose, bool one_at_a_time) {
    const FlushDenormals flush;
    const View view(camera, pose);
    for (Packet& packet : packets_) packet.start(view);
    alignas(64) constexpr std::array<int, kLanes> kAll = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                          -1, -1, -1, -1, -1, -1, -1, -1};
    for (int y0 = 0; y0 < view.height; y0 += 16)
      for (int x0 = 0; x0 < view.width; x0 += 64) {
        for (int k = 0; k < 64; ++k)
          packets_[static_cast<std::size_t>(k)].aim(view, x0 + k % 16 * 4, y0 + k / 16 * 4);
        for (Packet& packet : packets_)
          if (one_at_a_time)
            bvh_.intersect_each(packet.rays);
          else
            bvh_.intersect16(kAll.data(), packet.rays, true);
      }
  }

 private:
  EmbreeScene bvh_;
  std::vector<Packet> packets_;
};

/// What is timed, with its cost in each repeat.
struct Contestant {
  std::string name;
  std::function<void(const SE3&)> run;
  std::vector<Cost> costs{};

  double median(double Cost::*clock) const {
    std::vector<double> sorted;
    for (const Cost& cost : costs) sorted.push_back(cost.*clock);
    std::ranges::sort(sorted);
    return sorted[sorted.size() / 2];
  }
};

std::string load() {
  std::array<double, 1> minute{};
  return getloadavg(minute.data(), 1) == 1 ? fmt::format("{:.1f}", minute[0]) : "unknown";
}

void race(std::vector<Contestant>& contestants, int repeats) {
  fmt::print("load of the last minute {}\n", load());
  for (int repeat = -1; repeat < repeats; ++repeat)
    for (int view = 0; view < 12; ++view)
      for (Contestant& contestant : contestants) {
        const Cost begin = Cost::now();
        contestant.run(benchmark_view(view));
        const Cost cost = Cost::now().since(begin);
        if (repeat >= 0) contestant.costs.push_back(cost);  // the first repeat is a warm-up
      }
  fmt::print("  {:<38} {:>10} {:>13} {:>8}\n", "medians, ms", "its thread", "all threads", "wall");
  for (const Contestant& c : contestants)
    fmt::print("  {:<38} {:10.2f} {:13.2f} {:8.2f}\n", c.name, c.median(&Cost::thread_ms),
               c.median(&Cost::process_ms), c.median(&Cost::wall_ms));
  fmt::print("load of the last minute {}\n", load());
}

void print_ratio(const char* what, double ratio, const char* relation, double limit) {
  const bool good = *relation == '<' ? ratio <= limit : ratio >= limit;
  fmt::print("{:<66} {:6.2f}  (wanted {} {}) {}\n", what, ratio, relation, limit,
             good ? "good" : "MISSED");
}

Scene without_textures(Scene scene) {
  scene.uvs.clear();
  const RandomStream stream(3);
  for (std::size_t v = 0; v < scene.positions_m.size(); ++v) {
    const auto gray = static_cast<std::uint8_t>(stream.below(v, 256));
    scene.colors.push_back({gray, static_cast<std::uint8_t>(255 - gray), 128});
  }
  for (Material& material : scene.materials) material.texture = {};
  return scene;
}

int run(bool portable, int repeats) {
  const Camera camera;
  const Scene room = BenchmarkRoom::usual();
  const auto make = [&](const Scene& scene, int threads, Antialiasing antialiasing) {
    return make_embree_renderer(
        scene, {.threads = threads, .antialiasing = antialiasing, .portable = portable});
  };
  const auto image = [&](std::string name, const std::shared_ptr<const Renderer>& renderer) {
    return Contestant{std::move(name),
                      [&camera, renderer](const SE3& pose) { renderer->render(camera, pose); }};
  };
  RayTracer tracer(room, portable);
  std::vector<Contestant> contestants = {
      {"trace only", [&](const SE3& pose) { tracer.trace(camera, pose, false); }},
      {"trace only, one ray at a time", [&](const SE3& pose) { tracer.trace(camera, pose, true); }},
      image("vertex colors", make(without_textures(room), 1, Antialiasing::kNone)),
      image("textured", make(room, 1, Antialiasing::kNone)),
      image("textured, edges smoothed", make(room, 1, Antialiasing::kEdges)),
      image("textured, 2 x 2 supersampled", make(room, 1, Antialiasing::kSupersample)),
      image("vertex colors, 2 threads", make(without_textures(room), 2, Antialiasing::kNone)),
      image("textured, 2 threads", make(room, 2, Antialiasing::kNone)),
      image("ten times the triangles, textured",
            make(BenchmarkRoom::tenfold(), 1, Antialiasing::kNone)),
  };
  bool osmesa = true;
  try {
    contestants.push_back(
        image("OSMesa, vertex colors", make_osmesa_renderer(without_textures(room))));
    contestants.push_back(image("OSMesa, textured", make_osmesa_renderer(room)));
  } catch (const MachineError& error) {
    fmt::print("{}\n", error.what());
    osmesa = false;
  }
  fmt::print("{} triangles, {}x{}, {}\n", room.triangles.size(), camera.width_px, camera.height_px,
             portable ? "Embree pinned to AVX2" : "Embree's widest instructions");
  race(contestants, repeats);

  const auto ms = [&](std::size_t i) { return contestants[i].median(&Cost::thread_ms); };
  const double trace = ms(0), each = ms(1), color = ms(2), textured = ms(3);
  print_ratio("vertex colors, full output : trace only", color / trace, "<=", 1.3);
  print_ratio("textured and lit, full output : trace only", textured / trace, "<=", 2.0);
  print_ratio("edges smoothed : not", ms(4) / textured, "<=", 1.5);
  print_ratio("one ray at a time + same shading : vertex colors", (each + color - trace) / color,
              ">=", portable ? 3.0 : 4.0);
  print_ratio("one ray at a time + same shading : textured", (each + textured - trace) / textured,
              ">=", portable ? 3.0 : 4.0);
  if (osmesa) {
    const auto against_osmesa = [&](const char* what, std::size_t theirs, std::size_t ours) {
      const auto ratio = [&](double Cost::*clock) {
        return contestants[theirs].median(clock) / contestants[ours].median(clock);
      };
      print_ratio(what, ratio(&Cost::wall_ms), ">=", portable ? 5.0 : 8.0);
      fmt::print("{:<66} {:6.2f}\n", "  the same in work of all threads", ratio(&Cost::process_ms));
    };
    against_osmesa("OSMesa : vertex colors, 2 threads each, time on the wall", 9, 6);
    against_osmesa("OSMesa : textured, 2 threads each, time on the wall", 10, 7);
  }
  print_ratio("ten times the triangles : textured", ms(8) / textured, "<=", 2.5);
  return 0;
}

}  // namespace
}  // namespace mh

int main(int argc, char** argv) {
  // Keeps freed memory, so that rendering is timed and not the system's memory allocation.
  mallopt(M_MMAP_THRESHOLD, 64 << 20);
  mallopt(M_TRIM_THRESHOLD, 512 << 20);
  bool portable = false;
  int repeats = 7;
  for (int i = 1; i < argc; ++i)
    if (std::string_view(argv[i]) == "--portable")
      portable = true;
    else
      repeats = std::max(1, std::atoi(argv[i]));
  return mh::run(portable, repeats);
}
