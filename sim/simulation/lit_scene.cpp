// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation/lit_scene.hpp"

#include <utility>

#include "scenes/load.hpp"

namespace mh {
namespace {

float exposure_of(const Scene& scene) {
  return scene.light.empty() ? 1.0F : suggest_exposure(scene);
}

}  // namespace

void light_scene(Scene& scene, int threads, const BakeWatch& baked) {
  if (!scene.light.empty() || scene.lights.empty()) return;
  bake_light(scene, {.threads = threads}, baked);
}

Scene load_lit_scene(const std::filesystem::path& file, int threads,
                     std::vector<std::string>* warnings, const SceneFrame& frame,
                     const BakeWatch& baked) {
  Scene scene = load_scene(file, warnings, frame);
  light_scene(scene, threads, baked);
  return scene;
}

std::unique_ptr<Renderer> make_scene_renderer(const Scene& scene, std::string_view renderer) {
  return make_renderer(renderer, scene, {.exposure = exposure_of(scene)});
}

std::shared_ptr<const PedestrianScene> make_pedestrian_scene(
    const Scene& scene, std::shared_ptr<const Renderer> renderer, const Pedestrian& pedestrian) {
  return std::make_shared<const PedestrianScene>(scene, std::move(renderer), exposure_of(scene),
                                                 pedestrian);
}

}  // namespace mh
