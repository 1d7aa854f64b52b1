// SPDX-License-Identifier: Apache-2.0
// Time per 640x480 image (only traced, and with all outputs) and per sensed frame, of a generated
// room of 330,000 triangles with textures of block noise (near the worst case for a texture cache).
#include <benchmark/benchmark.h>

#include "bench/lab/micro/render_benchmark_room.hpp"
#include "sim/render/renderer.hpp"
#include "sim/sensors/sense.hpp"

namespace mh {
namespace {

const Scene& room() {
  static const Scene kRoom = BenchmarkRoom::usual();
  return kRoom;
}

void render_room(benchmark::State& state) {
  const auto renderer = make_embree_renderer(room(), {.threads = static_cast<int>(state.range(0))});
  int i = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(renderer->render(Camera{}, benchmark_view(i++ % 12)));
  state.counters["triangles"] = static_cast<double>(room().triangles.size());
}
BENCHMARK(render_room)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void sense_frame(benchmark::State& state) {
  const RenderedFrame truth = make_embree_renderer(room())->render(Camera{}, benchmark_view(0));
  const LabelMode labels = state.range(0) ? LabelMode::kBoxes : LabelMode::kNone;
  std::uint64_t seed = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(sense(truth, Camera{}, {}, RandomStream(++seed), 0));
    benchmark::DoNotOptimize(label_image(truth, labels));
  }
}
BENCHMARK(sense_frame)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mh

BENCHMARK_MAIN();
