// SPDX-License-Identifier: Apache-2.0
// Time to load typical user data: a ScanNet folder of 5 million triangles with labels, segments and
// objects; and a folder of 330,000 triangles, including the time to its first image.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>

#include "scenes/load.hpp"
#include "scenes/scannet/scannet.hpp"
#include "sim/render/renderer.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// A wavy floor of n x n squares, cut into tiles of 50 x 50 squares that are objects of many
/// classes, with vertices shared as in a scan.
Scene wavy_floor(std::uint32_t n) {
  Scene scene;
  scene.name = "floor";
  scene.materials = {{.name = "scan", .texture = {}}};
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) {
      const float x = 0.01F * static_cast<float>(i), y = 0.01F * static_cast<float>(j);
      scene.positions_m.emplace_back(x, y, 0.02F * std::sin(9.0F * x) * std::cos(7.0F * y));
      scene.colors.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j), 90});
    }
  const std::uint32_t tiles = (n + 49) / 50;
  for (std::uint32_t t = 0; t < tiles * tiles; ++t)
    scene.instances.push_back({.id = static_cast<InstanceId>(t + 1),
                               .class_id = static_cast<ClassId>(1 + t % 40),
                               .name = "tile_" + std::to_string(t)});
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t at = j * (n + 1) + i;
      const std::uint32_t tile = j / 50 * tiles + i / 50;
      for (const auto& triangle :
           {std::array{at, at + 1, at + n + 1}, std::array{at + 1, at + n + 2, at + n + 1}}) {
        scene.triangles.push_back(triangle);
        scene.material_of.push_back(0);
        scene.class_of.push_back(scene.instances[tile].class_id);
        scene.instance_of.push_back(scene.instances[tile].id);
      }
    }
  return scene;
}

/// A ScanNet folder of wavy_floor(squares); removed on destruction.
class ScanFolder {
 public:
  explicit ScanFolder(std::uint32_t squares)
      : path_(fs::temp_directory_path() /
              ("mh_scan_" + std::to_string(squares) + "_" + std::to_string(getpid()))) {
    save_scannet(wavy_floor(squares), path_);
  }
  ~ScanFolder() { fs::remove_all(path_); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void load_five_million_triangles(benchmark::State& state) {
  static const ScanFolder kFolder(1582);
  std::size_t triangles = 0;
  for (auto _ : state) {
    const Scene scene = load_scene(kFolder.path());
    triangles = scene.triangles.size();
    benchmark::DoNotOptimize(scene);
  }
  state.counters["triangles"] = static_cast<double>(triangles);
}
BENCHMARK(load_five_million_triangles)->Unit(benchmark::kMillisecond)->UseRealTime();

void load_to_first_pixel(benchmark::State& state) {
  static const ScanFolder kFolder(406);
  Camera one_pixel;
  one_pixel.width_px = one_pixel.height_px = 1;
  one_pixel.cx_px = one_pixel.cy_px = 0;
  Eigen::Matrix3d looking_down;
  looking_down << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  std::size_t triangles = 0;
  for (auto _ : state) {
    const Scene scene = load_scene(kFolder.path());
    triangles = scene.triangles.size();
    const auto image =
        make_embree_renderer(scene)->render(one_pixel, SE3(looking_down, {2.0, 2.0, 1.5}));
    if (image.depth_m(0, 0) == 0.0F) state.SkipWithError("nothing to be seen");
  }
  state.counters["triangles"] = static_cast<double>(triangles);
}
BENCHMARK(load_to_first_pixel)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace mh

BENCHMARK_MAIN();
