// SPDX-License-Identifier: Apache-2.0
#include "bench/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "bench/inputs/inputs.hpp"
#include "bench/inputs/run_key.hpp"
#include "bench/metrics/errors.hpp"
#include "bench/provenance/code_version.hpp"
#include "bench/provenance/digest.hpp"
#include "bench/provenance/fingerprint.hpp"
#include "scenes/load.hpp"
#include "sim/render/bake.hpp"
#include "sim/sensors/shutter.hpp"
#include "sim/sensors/visible_objects.hpp"
#include "sim/world/travel.hpp"
#include "slam/core/counted.hpp"
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

void light_scene(Scene& scene, int threads, const Cache& cache, const Say& say,
                 const BakeWatch& baked) {
  if (!scene.light.empty() || scene.lights.empty()) return;
  const BakeConfig config{.threads = threads};
  const std::string key = text_key(fmt::format(
      "{} {} {} {} {} {} {} {}", code_of_light(), fingerprint_json().dump(), hex(digest(scene)),
      config.samples, config.bounces, config.sun_samples, config.smoothing, config.seed));
  const std::string light = cache.get("light", key, [&] {
    if (say) say(fmt::format("baking the light of {}", scene.name));
    bake_light(scene, config, baked);
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
                     const Say& say, std::vector<std::string>* warnings, const SceneFrame& frame,
                     const BakeWatch& baked) {
  Scene scene = load_scene(file, warnings, frame);
  light_scene(scene, threads, cache, say, baked);
  return scene;
}

std::string check_labels(const Scene& scene, LabelMode labels) {
  if (labels != LabelMode::kBoxes && labels != LabelMode::kDetector) return "";
  if (std::ranges::all_of(scene.instance_of, [](InstanceId id) { return id == 0; }))
    throw InputError(fmt::format(
        "{}: labels '{}' are boxes around objects, and its faces belong to none: all would be "
        "background; use 'exact' or 'none'",
        scene.name, name(labels)));
  const auto& of = scene.instances;
  if (std::ranges::any_of(of, [](const Instance& i) { return is_coco(i.class_id); })) return "";
  return fmt::format(
      "{}: none of its {} is of a class that a detector knows: labels '{}' are background "
      "everywhere",
      scene.name, counted(of.size(), "object"), name(labels));
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
  std::optional<Walk> walk;
  if (environment.walk)
    walk = input("walk", *environment.walk, [&] { return load_walk(*environment.walk); });

  const auto lit_scene = [&](const char* name, const std::filesystem::path& file) {
    Scene scene = input(name, file, [&] { return load_scene(file, nullptr, environment.frame); });
    light_scene(scene, threads, cache, say, baked);
    return std::make_shared<const Scene>(std::move(scene));
  };
  const auto scene = lit_scene("scene", environment.scene);
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
  world.mapping = input("mapping_tour", environment.mapping_tour, [&] {
    return travel(*scene, world.robot, environment.mapping_tour, walker(0));
  });
  if (environment.kidnapped_tour) {
    const DrivenPath elsewhere = travel(*scene, world.robot, environment.kidnapped_tour->string(),
                                        walker(world.mapping.camera.size()));
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
