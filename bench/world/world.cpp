// SPDX-License-Identifier: Apache-2.0
#include "bench/world/world.hpp"

#include <fmt/format.h>

#include "scenes/load.hpp"
#include "sim/render/bake.hpp"

namespace mh {
namespace {

void cut(DrivenPath& path, std::optional<std::size_t> max_frames) {
  if (!max_frames || path.camera.size() <= *max_frames) return;
  path.camera.resize(*max_frames);
  path.base.resize(*max_frames);
}

}  // namespace

void light_scene(Scene& scene, int threads) {
  if (scene.light.empty() && !scene.lights.empty()) bake_light(scene, {.threads = threads});
}

Scene load_lit_scene(const std::filesystem::path& file, int threads) {
  Scene scene = load_scene(file);
  light_scene(scene, threads);
  return scene;
}

std::unique_ptr<Renderer> make_scene_renderer(const Scene& scene) {
  return make_embree_renderer(scene,
                              {.exposure = scene.light.empty() ? 1.0F : suggest_exposure(scene)});
}

World build_world(const Suite& suite, std::optional<std::size_t> max_frames, int threads,
                  const Say& say) {
  // What is cheap to check comes first, so that a slip is told within a second.
  World world;
  world.robot = load_robot(suite.robot);
  world.vocabulary = std::make_shared<const Vocabulary>(Vocabulary::load(suite.vocabulary));
  for (const auto& level : suite.levels) world.levels.push_back(load_sensor_config(level));
  const Tour mapping_tour = load_tour(suite.mapping_tour);
  std::optional<Tour> query_tour;
  if (suite.query_tour) query_tour = load_tour(*suite.query_tour);

  say(fmt::format("scene {}", suite.scene.string()));
  auto scene = std::make_shared<const Scene>(load_lit_scene(suite.scene, threads));
  world.scene = scene;
  world.renderer = make_scene_renderer(*scene);

  say(fmt::format("driving {}", mapping_tour.name));
  world.mapping = drive(*scene, world.robot, mapping_tour);
  cut(world.mapping, max_frames);
  if (query_tour) {
    say(fmt::format("driving {}", query_tour->name));
    world.second = drive(*scene, world.robot, *query_tour);
    cut(*world.second, max_frames);
  }
  return world;
}

}  // namespace mh
