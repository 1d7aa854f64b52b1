// SPDX-License-Identifier: Apache-2.0
#include "bench/world/world.hpp"

#include <limits>

#include <fmt/format.h>

#include "bench/metrics/errors.hpp"
#include "bench/protocol/digest.hpp"
#include "scenes/load.hpp"
#include "sim/render/bake.hpp"
#include "slam/core/files.hpp"

namespace mh {
namespace {

std::vector<InputDigest> digest_inputs(const Suite& suite) {
  std::vector<InputDigest> inputs;
  const auto add = [&](std::string name, const std::filesystem::path& file) {
    const std::string content = read_file(file);
    inputs.push_back({std::move(name), digest_bytes(content.data(), content.size())});
  };
  add("suite", suite.file);
  add("scene", suite.scene);
  add("robot", suite.robot);
  add("mapping_tour", suite.mapping_tour);
  if (suite.query_tour) add("query_tour", *suite.query_tour);
  add("vocabulary", suite.vocabulary);
  for (const auto& level : suite.levels) add("level " + level_name(level), level);
  return inputs;
}

}  // namespace

bool cut(DrivenPath& path, std::size_t max_frames) {
  if (path.camera.size() <= max_frames) return false;
  path.camera.resize(max_frames);
  path.base.resize(max_frames);
  path.length_m = path_length_m(path.base);
  path.turned_in_place_rad = path.contact_time_s = path.max_penetration_m =
      std::numeric_limits<double>::quiet_NaN();
  return true;
}

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
  world.inputs = digest_inputs(suite);
  const auto shorten = [&](DrivenPath& path) {
    if (max_frames && cut(path, *max_frames)) world.frames = max_frames;
  };
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
  shorten(world.mapping);
  if (query_tour) {
    say(fmt::format("driving {}", query_tour->name));
    world.second = drive(*scene, world.robot, *query_tour);
    shorten(*world.second);
  }
  return world;
}

}  // namespace mh
