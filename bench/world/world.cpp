// SPDX-License-Identifier: Apache-2.0
#include "bench/world/world.hpp"

#include <limits>

#include <fmt/format.h>

#include "bench/metrics/errors.hpp"
#include "bench/protocol/digest.hpp"
#include "scenes/load.hpp"
#include "sim/render/bake.hpp"
#include "sim/sensors/shutter.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"

namespace mh {
namespace {

std::vector<InputDigest> digest_inputs(const RunSpec& spec) {
  std::vector<InputDigest> inputs;
  const auto add = [&](std::string name, const std::filesystem::path& source) {
    const std::string content = is_generated(source) ? source.string() : read_file(source);
    inputs.push_back({std::move(name), digest_bytes(content.data(), content.size())});
  };
  add("scene", spec.environment.scene);
  add("robot", spec.environment.robot);
  add("mapping_tour", spec.environment.mapping_tour);
  if (spec.environment.query_tour) add("query_tour", *spec.environment.query_tour);
  add("vocabulary", spec.vocabulary);
  add("level", spec.level);
  return inputs;
}

/// @throws InputError where the source is one that no code makes yet.
void check_available(const std::filesystem::path& source, const char* what) {
  if (is_generated(source))
    throw InputError(
        fmt::format("{} '{}' is not available yet: generated environments come with a "
                    "later version",
                    what, source.string()));
}

PathFacts facts(const DrivenPath& path) {
  return {path.camera.size(), path.length_m, path.turned_in_place_rad, path.contact_time_s,
          path.max_penetration_m};
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

std::unique_ptr<Renderer> make_scene_renderer(const Scene& scene, std::string_view renderer) {
  return make_renderer(renderer, scene,
                       {.exposure = scene.light.empty() ? 1.0F : suggest_exposure(scene)});
}

PlaceFacts facts(const World& world) {
  PlaceFacts f{.scene = world.scene->name,
               .robot = world.robot.name,
               .scene_digest = digest(*world.scene),
               .path_digest = digest(world.mapping.camera),
               .vocabulary_digest = world.vocabulary->digest(),
               .vocabulary_words = world.vocabulary->size(),
               .mapping = facts(world.mapping),
               .second = {},
               .cut = world.cut,
               .inputs = world.inputs};
  if (world.second) {
    f.second = facts(*world.second);
    const std::uint64_t second = digest(world.second->camera);
    f.path_digest = digest_bytes(&second, sizeof second, f.path_digest);
  }
  return f;
}

World build_world(const RunSpec& spec, int threads, const Say& say) {
  // What is cheap to check comes first, so that a slip is told within a second.
  const Environment& environment = spec.environment;
  check_available(environment.scene, "scene");
  check_available(environment.mapping_tour, "tour");
  if (environment.query_tour) check_available(*environment.query_tour, "tour");
  World world;
  world.inputs = digest_inputs(spec);
  const auto shorten = [&](DrivenPath& path) {
    if (spec.max_frames && cut(path, *spec.max_frames)) world.cut = true;
  };
  world.robot = load_robot(environment.robot);
  world.vocabulary = std::make_shared<const Vocabulary>(Vocabulary::load(spec.vocabulary));
  world.sensors = load_sensor_config(spec.level);
  world.robot.camera = with_lens(world.robot.camera, world.sensors);
  const Tour mapping_tour = load_tour(environment.mapping_tour);
  std::optional<Tour> query_tour;
  if (environment.query_tour) query_tour = load_tour(*environment.query_tour);

  say(fmt::format("scene {}", environment.scene.string()));
  auto scene = std::make_shared<const Scene>(load_lit_scene(environment.scene, threads));
  world.scene = scene;
  world.renderer = make_scene_renderer(*scene);

  const auto lose_frames = [&](DrivenPath& path) {
    const RandomStream same_for_every_trial(0);
    path.camera = arriving_frames(path.camera, world.sensors, same_for_every_trial);
    path.base = arriving_frames(path.base, world.sensors, same_for_every_trial);
  };
  say(fmt::format("driving {}", mapping_tour.name));
  world.mapping = drive(*scene, world.robot, mapping_tour);
  lose_frames(world.mapping);
  shorten(world.mapping);
  if (query_tour) {
    say(fmt::format("driving {}", query_tour->name));
    world.second = drive(*scene, world.robot, *query_tour);
    lose_frames(*world.second);
    shorten(*world.second);
  }
  return world;
}

}  // namespace mh
