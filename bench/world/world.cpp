// SPDX-License-Identifier: Apache-2.0
#include "bench/world/world.hpp"

#include <algorithm>

#include "bench/inputs/inputs.hpp"
#include "bench/provenance/digest.hpp"
#include "bench/world/cached_light.hpp"
#include "scenes/load.hpp"
#include "sim/sensors/shutter.hpp"
#include "sim/world/lit_scene.hpp"
#include "sim/world/travel.hpp"

namespace mh {
namespace {

PathFacts facts(const DrivenPath& path) {
  return {path.camera.size(), path.length_m, path.turned_in_place_rad, path.contact_time_s,
          path.max_penetration_m};
}

}  // namespace

PlaceFacts facts(const World& world) {
  PlaceFacts f{.scene = world.scene->name,
               .robot = world.robot.name,
               .scene_digest = digest(*world.scene),
               .path_digest = digest(world.mapping.camera),
               .vocabulary_digest = world.vocabulary ? world.vocabulary->digest() : 0,
               .vocabulary_words = world.vocabulary ? world.vocabulary->size() : 0,
               .mapping = facts(world.mapping),
               .second = {},
               .cut = world.cut,
               .inputs = world.inputs};
  if (world.second_scene) {
    const std::uint64_t second = digest(*world.second_scene);
    f.scene_digest = digest_bytes(&second, sizeof second, f.scene_digest);
  }
  if (world.second) {
    f.second = facts(*world.second);
    const std::uint64_t second = digest(world.second->camera);
    f.path_digest = digest_bytes(&second, sizeof second, f.path_digest);
  }
  return f;
}

namespace {

/// With the inputs of everything but an outside program.
World build(const RunSpec& spec, int threads, const Cache& cache, const Say& say,
            const BakeWatch& baked) {
  const Environment& environment = spec.environment;
  World world;
  const auto input = [&](const char* name, const std::filesystem::path& source, auto&& load) {
    return noted(world.inputs, name, source, load);
  };
  const auto shorten = [&](DrivenPath& path) {
    if (spec.max_frames && cut(path, *spec.max_frames)) world.cut = true;
  };
  world.robot = input("robot", environment.robot, [&] { return load_robot(environment.robot); });
  if (!spec.vocabulary.empty())
    world.vocabulary = std::make_shared<const Vocabulary>(
        input("vocabulary", spec.vocabulary, [&] { return Vocabulary::load(spec.vocabulary); }));
  world.sensors = input("level", spec.level, [&] { return load_sensor_config(spec.level); });
  if (environment.sensors)
    world.sensors = input("sensors", *environment.sensors,
                          [&] { return load_sensor_config(*environment.sensors); });
  world.robot.camera = with_lens(world.robot.camera, world.sensors);
  if (environment.kidnapped_tour)
    input("kidnapped_tour", *environment.kidnapped_tour,
          [&] { return load_tour(*environment.kidnapped_tour); });
  std::optional<Pedestrian> pedestrian;
  if (environment.pedestrian)
    pedestrian = input("pedestrian", *environment.pedestrian,
                       [&] { return load_pedestrian(*environment.pedestrian); });

  const auto lit_scene = [&](const char* name, const std::filesystem::path& file) {
    Scene scene = input(name, file, [&] { return load_scene(file, nullptr, environment.frame); });
    light_from_cache(scene, threads, cache, say, baked);
    return std::make_shared<const Scene>(std::move(scene));
  };
  const auto scene = lit_scene("scene", environment.scene);
  world.scene = scene;
  world.renderer = make_scene_renderer(*scene);
  if (pedestrian)
    world.pedestrian_scene = make_pedestrian_scene(*scene, world.renderer, *pedestrian);

  const auto lose_frames = [&](DrivenPath& path) {
    const RandomStream same_for_every_trial(0);
    path.camera = arriving_frames(path.camera, world.sensors, same_for_every_trial);
    path.base = arriving_frames(path.base, world.sensors, same_for_every_trial);
  };
  const double rate_hz = world.robot.camera.rate_hz;
  const auto obstacles = [&](std::size_t frames_before) {
    std::vector<MovingObstacle> others;
    if (pedestrian)
      others.push_back(
          as_obstacle(*scene, *pedestrian, static_cast<double>(frames_before) / rate_hz));
    return others;
  };
  world.mapping = input("mapping_tour", environment.mapping_tour, [&] {
    return travel(*scene, world.robot, environment.mapping_tour, obstacles(0));
  });
  if (environment.kidnapped_tour) {
    const DrivenPath elsewhere = travel(*scene, world.robot, environment.kidnapped_tour->string(),
                                        obstacles(world.mapping.camera.size()));
    world.mapping = joined(std::move(world.mapping), elsewhere, rate_hz);
  }
  lose_frames(world.mapping);
  shorten(world.mapping);
  if (!environment.query_tour) return world;

  if (environment.query_scene) {
    world.second_scene = lit_scene("query_scene", *environment.query_scene);
    world.second_renderer = make_scene_renderer(*world.second_scene);
  }
  world.second = input("query_tour", *environment.query_tour, [&] {
    return travel(world.second_scene ? *world.second_scene : *scene, world.robot,
                  *environment.query_tour);
  });
  lose_frames(*world.second);
  shorten(*world.second);
  return world;
}

}  // namespace

World build_world(const RunSpec& spec, int threads, const Cache& cache, const Say& say,
                  const BakeWatch& baked) {
  World world = build(spec, threads, cache, say, baked);
  std::ranges::move(inputs_of_program(spec), std::back_inserter(world.inputs));
  std::ranges::sort(world.inputs, {}, &InputDigest::name);
  return world;
}

}  // namespace mh
