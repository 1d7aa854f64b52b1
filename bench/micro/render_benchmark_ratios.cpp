// SPDX-License-Identifier: Apache-2.0
// Ratios of rendering times at 640x480: medians over interleaved repeats of twelve views, beside
// the limits that docs/rendering.md states. What runs on one thread is timed by that thread's
// clock; two threads and OSMesa by their process's: ratios of work, whatever else the machine does.
// Usage: render_ratios [--portable] [repeats]
#include <malloc.h>
#include <time.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "bench/micro/render_benchmark_room.hpp"
#include "sim/render/packet.hpp"
#include "sim/render/renderer.hpp"
#include "slam/core/error.hpp"

namespace mh {
namespace {

// Where two threads work: what they and those of OSMesa use together, on a machine that is shared.
constexpr clockid_t kSharedClock = CLOCK_PROCESS_CPUTIME_ID;

/// Rays of a whole picture and nothing else, in the renderer's order.
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

/// What is timed, and how long it took each time.
struct Contestant {
  std::string name;
  std::function<void(const SE3&)> run;
  clockid_t clock = CLOCK_THREAD_CPUTIME_ID;
  std::vector<double> times_ms{};

  double median_ms() const {
    std::vector<double> sorted = times_ms;
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() / 2];
  }
};

void race(std::vector<Contestant>& contestants, int repeats) {
  const auto now_ms = [](clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
  };
  for (int repeat = -1; repeat < repeats; ++repeat)
    for (int view = 0; view < 12; ++view)
      for (Contestant& contestant : contestants) {
        const double begin = now_ms(contestant.clock);
        contestant.run(benchmark_view(view));
        const double time = now_ms(contestant.clock) - begin;
        if (repeat >= 0) contestant.times_ms.push_back(time);  // the first round warms up
      }
  for (const Contestant& c : contestants)
    fmt::print("  {:<44} {:8.2f} ms\n", c.name, c.median_ms());
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
    const auto grey = static_cast<std::uint8_t>(stream.below(v, 256));
    scene.colours.push_back({grey, static_cast<std::uint8_t>(255 - grey), 128});
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
  const auto picture = [&](std::string name, const std::shared_ptr<const Renderer>& renderer,
                           clockid_t clock = CLOCK_THREAD_CPUTIME_ID) {
    return Contestant{std::move(name),
                      [&camera, renderer](const SE3& pose) { renderer->render(camera, pose); },
                      clock};
  };
  RayTracer tracer(room, portable);
  std::vector<Contestant> contestants = {
      {"trace only", [&](const SE3& pose) { tracer.trace(camera, pose, false); }},
      {"trace only, one ray at a time", [&](const SE3& pose) { tracer.trace(camera, pose, true); }},
      picture("vertex colours", make(without_textures(room), 1, Antialiasing::kNone)),
      picture("textured", make(room, 1, Antialiasing::kNone)),
      picture("textured, edges smoothed", make(room, 1, Antialiasing::kEdges)),
      picture("textured, 2 x 2 supersampled", make(room, 1, Antialiasing::kSupersample)),
      picture("vertex colours, 2 threads", make(without_textures(room), 2, Antialiasing::kNone),
              kSharedClock),
      picture("textured, 2 threads", make(room, 2, Antialiasing::kNone), kSharedClock),
      picture("ten times the triangles, textured",
              make(BenchmarkRoom::tenfold(), 1, Antialiasing::kNone)),
  };
  bool osmesa = true;
  try {
    contestants.push_back(picture("OSMesa, vertex colours",
                                  make_osmesa_renderer(without_textures(room)), kSharedClock));
    contestants.push_back(picture("OSMesa, textured", make_osmesa_renderer(room), kSharedClock));
  } catch (const MachineError& error) {
    fmt::print("{}\n", error.what());
    osmesa = false;
  }
  fmt::print("{} triangles, {}x{}, {}\n", room.triangles.size(), camera.width_px, camera.height_px,
             portable ? "Embree pinned to AVX2" : "Embree's widest instructions");
  race(contestants, repeats);

  const auto ms = [&](std::size_t i) { return contestants[i].median_ms(); };
  const double trace = ms(0), each = ms(1), colour = ms(2), textured = ms(3);
  print_ratio("vertex colours, full output : trace only", colour / trace, "<=", 1.3);
  print_ratio("textured and lit, full output : trace only", textured / trace, "<=", 2.0);
  print_ratio("edges smoothed : not", ms(4) / textured, "<=", 1.5);
  print_ratio("one ray at a time + same shading : vertex colours", (each + colour - trace) / colour,
              ">=", portable ? 3.0 : 4.0);
  print_ratio("one ray at a time + same shading : textured", (each + textured - trace) / textured,
              ">=", portable ? 3.0 : 4.0);
  if (osmesa) {
    print_ratio("OSMesa : vertex colours, 2 threads", ms(9) / ms(6), ">=", portable ? 5.0 : 8.0);
    print_ratio("OSMesa : textured, 2 threads", ms(10) / ms(7), ">=", portable ? 5.0 : 8.0);
  }
  print_ratio("ten times the triangles : textured", ms(8) / textured, "<=", 2.5);
  return 0;
}

}  // namespace
}  // namespace mh

int main(int argc, char** argv) {
  // What is timed is the rendering, not the system's handing out of memory.
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
