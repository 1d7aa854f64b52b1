// SPDX-License-Identifier: Apache-2.0
// Agreement of the ray tracer and the rasterizer over random views of five scenes, with the limits
// stated in docs/measurements/rendering.md.
// Usage: render_agreement [--portable] [views per scene]
#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "bench/lab/micro/render_benchmark_room.hpp"
#include "scenes/load.hpp"
#include "scenes/vocabulary_rooms/vocabulary_rooms.hpp"
#include "sim/render/agreement.hpp"
#include "sim/render/bake.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

/// Views from free places at a camera's height, in any direction except straight up or down. The
/// camera is rolled, since vertical edges in level images would make whole columns of ties.
std::vector<SE3> random_views(const Scene& scene, std::uint64_t seed, int count) {
  std::vector<SE3> views;
  const RandomStream stream(seed);
  for (const SE3& level : training_views(scene, seed, count)) {
    const auto angle = [&](std::uint64_t k) {
      return stream.uniform(3 * views.size() + k, -0.35, 0.35);
    };
    const Eigen::Matrix3d askew = (Eigen::AngleAxisd(angle(0), Eigen::Vector3d::UnitX()) *
                                   Eigen::AngleAxisd(angle(1), Eigen::Vector3d::UnitY()) *
                                   Eigen::AngleAxisd(angle(2), Eigen::Vector3d::UnitZ()))
                                      .toRotationMatrix();
    views.emplace_back(Eigen::Matrix3d(level.rotation() * askew), level.translation());
  }
  return views;
}

std::vector<Scene> five_scenes() {
  std::vector<Scene> scenes;
  scenes.push_back(load_scene("scenes/model_house/house.yaml"));
  for (const std::uint64_t seed : {1, 2, 3}) scenes.push_back(make_training_room(seed));
  for (Scene& scene : scenes) bake_light(scene, {.samples = 32, .bounces = 1});
  Scene room = BenchmarkRoom::usual();
  room.rooms.push_back({"room", {{0, 0}, {8, 0}, {8, 7.5}, {0, 7.5}}});
  scenes.push_back(std::move(room));
  return scenes;
}

void print(std::string_view name, const Agreement& a) {
  fmt::print(
      "{:<24} class {:.4f} %  instance {:.4f} % + {:.4f} % ties  color {:.3f} %  depth {:.2e} m "
      "({:.1f} % of pixels outside silhouettes)\n",
      name, 100 * a.class_share(), 100 * a.instance_share(), 100 * a.tie_share(),
      100 * a.color_share(), a.depth_rmse_m(),
      100.0 * static_cast<double>(a.smooth) / static_cast<double>(a.pixels));
}

int run(bool portable, int views) {
  Agreement all;
  for (const Scene& scene : five_scenes()) {
    const float exposure = suggest_exposure(scene);
    const auto embree = make_embree_renderer(
        scene, {.exposure = exposure, .antialiasing = Antialiasing::kNone, .portable = portable});
    const auto osmesa = make_osmesa_renderer(scene, {.exposure = exposure});
    Agreement agreement;
    for (const SE3& view : random_views(scene, 11, views)) {
      const RenderedFrame a = embree->render(Camera{}, view), b = osmesa->render(Camera{}, view);
      agreement.add(a, b);
      all.add(a, b);
    }
    print(scene.name, agreement);
  }
  print("all", all);
  const bool good = all.class_share() >= 0.9999 &&
                    all.instance_share() + all.tie_share() >= 0.9999 &&
                    all.color_share() >= 0.995 && all.depth_rmse_m() <= 1e-4;
  fmt::print("wanted: class and instance (ties apart) 99.99 %, color 99.5 %, depth 1e-4 m: {}\n",
             good ? "good" : "MISSED");
  return good ? 0 : 1;
}

}  // namespace
}  // namespace mh

int main(int argc, char** argv) {
  bool portable = false;
  int views = 40;
  for (int i = 1; i < argc; ++i)
    if (std::string_view(argv[i]) == "--portable")
      portable = true;
    else
      views = std::max(1, std::atoi(argv[i]));
  try {
    return mh::run(portable, views);
  } catch (const std::exception& error) {
    fmt::print(stderr, "render_agreement: error: {}\n", error.what());
    return 3;
  }
}
