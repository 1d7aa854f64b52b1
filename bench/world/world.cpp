// SPDX-License-Identifier: Apache-2.0
#include "bench/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "bench/metrics/errors.hpp"
#include "bench/protocol/digest.hpp"
#include "bench/results/fingerprint.hpp"
#include "bench/store/code_version.hpp"
#include "bench/store/run_key.hpp"
#include "bench/world/travel.hpp"
#include "scenes/generate/generate.hpp"
#include "scenes/load.hpp"
#include "sim/render/bake.hpp"
#include "sim/sensors/shutter.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"

namespace mh {
namespace {

float exposure_of(const Scene& scene) {
  return scene.light.empty() ? 1.0F : suggest_exposure(scene);
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

DrivenPath joined(DrivenPath first, const DrivenPath& second, double rate_hz) {
  const auto add = [rate_hz](Trajectory& path, const Trajectory& more) {
    for (const TimedPose& pose : more)
      path.push_back(
          {std::llround(static_cast<double>(path.size()) * 1e9 / rate_hz), pose.world_from_camera});
  };
  add(first.camera, second.camera);
  add(first.base, second.base);
  first.length_m += second.length_m;
  first.turned_in_place_rad += second.turned_in_place_rad;
  first.max_penetration_m = std::max(first.max_penetration_m, second.max_penetration_m);
  first.contact_time_s += second.contact_time_s;
  return first;
}

void light_scene(Scene& scene, int threads, const Cache& cache, const Say& say) {
  if (!scene.light.empty() || scene.lights.empty()) return;
  const BakeConfig config{.threads = threads};
  const std::string key = text_key(fmt::format(
      "{} {} {} {} {} {} {} {}", code_of_light(), fingerprint_json().dump(), hex(digest(scene)),
      config.samples, config.bounces, config.sun_samples, config.smoothing, config.seed));
  const std::string light = cache.get("light", key, [&] {
    say(fmt::format("baking the light of {}", scene.name));
    bake_light(scene, config);
    return std::string(reinterpret_cast<const char*>(scene.light.data()),
                       scene.light.size() * sizeof(Eigen::Vector3f));
  });
  if (light.size() != scene.positions_m.size() * sizeof(Eigen::Vector3f))
    throw MachineError(fmt::format("{}: holds an entry that does not fit its key: remove it",
                                   cache.folder().string()));
  scene.light.resize(scene.positions_m.size());
  std::memcpy(static_cast<void*>(scene.light.data()), light.data(), light.size());
}

Scene load_lit_scene(const std::filesystem::path& file, int threads, const Cache& cache,
                     const Say& say) {
  Scene scene = load_scene(file);
  light_scene(scene, threads, cache, say);
  return scene;
}

std::unique_ptr<Renderer> make_scene_renderer(const Scene& scene, std::string_view renderer) {
  return make_renderer(renderer, scene, {.exposure = exposure_of(scene)});
}

std::shared_ptr<const WalkedScene> make_walked_scene(const Scene& scene,
                                                     std::shared_ptr<const Renderer> renderer,
                                                     const Walk& walk) {
  return std::make_shared<const WalkedScene>(scene, std::move(renderer), exposure_of(scene), walk);
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

void check_inputs(const RunSpec& spec) {
  const Environment& environment = spec.environment;
  if (is_generated(environment.scene)) parse_generated(environment.scene.string());
  load_robot(environment.robot);
  load_sensor_config(spec.level);
  check_motion(environment.mapping_tour);
  if (environment.query_tour) check_motion(*environment.query_tour);
}

World build_world(const RunSpec& spec, int threads, const Cache& cache, const Say& say) {
  const Environment& environment = spec.environment;
  check_inputs(spec);
  World world;
  world.inputs = digest_inputs(spec);
  const auto shorten = [&](DrivenPath& path) {
    if (spec.max_frames && cut(path, *spec.max_frames)) world.cut = true;
  };
  world.robot = load_robot(environment.robot);
  world.vocabulary = std::make_shared<const Vocabulary>(Vocabulary::load(spec.vocabulary));
  world.sensors = load_sensor_config(environment.sensors.value_or(spec.level));
  world.robot.camera = with_lens(world.robot.camera, world.sensors);
  std::optional<Tour> kidnapped_tour;
  if (environment.kidnapped_tour) kidnapped_tour = load_tour(*environment.kidnapped_tour);
  std::optional<Walk> walk;
  if (environment.walk) walk = load_walk(*environment.walk);

  auto scene =
      std::make_shared<const Scene>(load_lit_scene(environment.scene, threads, cache, say));
  world.scene = scene;
  world.renderer = make_scene_renderer(*scene);
  if (walk) world.walked = make_walked_scene(*scene, world.renderer, *walk);

  const auto lose_frames = [&](DrivenPath& path) {
    const RandomStream same_for_every_trial(0);
    path.camera = arriving_frames(path.camera, world.sensors, same_for_every_trial);
    path.base = arriving_frames(path.base, world.sensors, same_for_every_trial);
  };
  const double rate_hz = world.robot.camera.rate_hz;
  const auto walker = [&](std::size_t frames_before) {
    std::vector<MovingObstacle> others;
    if (walk)
      others.push_back(as_obstacle(*scene, *walk, static_cast<double>(frames_before) / rate_hz));
    return others;
  };
  world.mapping = travel(*scene, world.robot, environment.mapping_tour, walker(0));
  if (kidnapped_tour) {
    const DrivenPath elsewhere =
        drive(*scene, world.robot, *kidnapped_tour, walker(world.mapping.camera.size()));
    world.mapping = joined(std::move(world.mapping), elsewhere, rate_hz);
  }
  lose_frames(world.mapping);
  shorten(world.mapping);
  if (!environment.query_tour) return world;

  if (environment.query_scene) {
    world.second_scene = std::make_shared<const Scene>(
        load_lit_scene(*environment.query_scene, threads, cache, say));
    world.second_renderer = make_scene_renderer(*world.second_scene);
  }
  world.second = travel(world.second_scene ? *world.second_scene : *scene, world.robot,
                        *environment.query_tour);
  lose_frames(*world.second);
  shorten(*world.second);
  return world;
}

}  // namespace mh
