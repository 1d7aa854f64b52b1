// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/world/variant.hpp"

#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "bench/protocol/world/world.hpp"
#include "bench/suite/inputs.hpp"
#include "robots/navigation/navigator.hpp"
#include "scenes/load.hpp"
#include "sim/simulation/lit_scene.hpp"
#include "sim/simulation/pedestrian.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

void require_level_floor(const Scene& scene) {
  if (!scene.floor.is_level_zero())
    throw InputError(fmt::format(
        "{}: its floor is not at z = 0: episodes drive in houses and generated rooms", scene.name));
}

void require_equipped(const RunSpec& spec, const Robot& robot) {
  if (const char* part = lacking_to_drive(robot))
    throw InputError(fmt::format("{}: robot '{}' has no {}: it cannot drive on its own",
                                 spec.environment.robot.string(), robot.name, part));
}

/// The files that a variant reads.
struct VariantFiles {
  std::optional<Scene> scene;
  std::optional<Pedestrian> pedestrian;
  std::optional<SensorConfig> level;
};

VariantFiles load_files(const EpisodeVariant& variant, std::vector<InputDigest>& inputs) {
  VariantFiles files;
  sources(variant, [&](const WorldSource& source, const auto& file) {
    if (!file) return;
    noted(inputs, input_name(variant, source), *file, [&] {
      if (source.kind == SourceKind::kScene)
        files.scene = load_scene(*file);
      else if (source.kind == SourceKind::kPedestrian)
        files.pedestrian = load_pedestrian(*file);
      else
        files.level = load_sensor_config(*file);
      return true;
    });
  });
  return files;
}

VariantPlace make_variant(const EpisodeVariant& variant, const RunSpec& spec,
                          const SimulatedPlace& mapped, VariantFiles files,
                          const std::function<void(Scene&)>& light) {
  VariantPlace made{.name = variant.name,
                    .scene = {mapped.scene, mapped.renderer},
                    .level = mapped.sensors,
                    .starts = {}};
  if (files.scene) {
    light(*files.scene);
    made.scene.scene = std::make_shared<const Scene>(*std::move(files.scene));
    made.scene.renderer = make_scene_renderer(*made.scene.scene);
  }
  require_level_floor(*made.scene.scene);
  if (files.pedestrian)
    made.scene.pedestrian =
        make_pedestrian_scene(*made.scene.scene, made.scene.renderer, *files.pedestrian);
  if (files.level) {
    made.level = with_dials(*files.level, labels_of_frames(spec));
    made.level.lens_distortion = mapped.sensors.lens_distortion;  // it is still the same camera
  }
  made.starts = draw_starts(*spec.episodes, *made.scene.scene, mapped.robot);
  return made;
}

}  // namespace

std::vector<VariantPlace> make_variants(const RunSpec& spec, const SimulatedPlace& mapped,
                                        std::vector<InputDigest>& inputs,
                                        const std::function<void(Scene&)>& light) {
  require_equipped(spec, mapped.robot);
  std::vector<VariantPlace> made;
  for (const EpisodeVariant& variant : spec.episodes->variants)
    made.push_back(make_variant(variant, spec, mapped, load_files(variant, inputs), light));
  return made;
}

void require_goals(const RunSpec& spec) {
  const Robot robot = load_robot(spec.environment.robot);
  require_equipped(spec, robot);
  EpisodesSpec one = *spec.episodes;
  one.starts = 1;
  std::set<std::filesystem::path> seen;
  for (const EpisodeVariant& variant : one.variants) {
    const std::filesystem::path file = variant.scene.value_or(spec.environment.scene);
    if (!seen.insert(file).second) continue;
    const Scene scene =
        load_scene(file, nullptr, variant.scene ? SceneFrame{} : spec.environment.frame);
    require_level_floor(scene);
    draw_starts(one, scene, robot);
  }
}

}  // namespace mh
