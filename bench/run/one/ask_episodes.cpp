// SPDX-License-Identifier: Apache-2.0
#include "bench/run/one/ask_episodes.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/suite/json_fields.hpp"
#include "sim/motion/sensing.hpp"
#include "sim/physics/planar_world.hpp"
#include "slam/core/digest.hpp"

namespace mh {
namespace {

RobotMap map_of(const RunSpec& spec, const World& world, const Trajectory& estimate,
                RandomStream noise) {
  const SimulatedPlace& place = *world.simulated;
  PlanarWorld seen(*place.scene, place.robot, Eigen::Vector2d::Zero(), 0);
  const auto ticks = static_cast<std::size_t>(spec.episodes->ticks_per_frame);
  return build_robot_map(
      {.frames = *world.mapping,
       .estimate = estimate,
       .robot = place.robot,
       .noise = noise,
       .lasers = [&](std::size_t frame) {
         const SE3& world_from_base = place.mapping.base[frame * ticks].world_from_camera;
         return read_lasers(seen, *place.robot.equipment, world_from_base, noise.fork(frame));
       }});
}

}  // namespace

std::vector<EpisodeScore> ask_episodes(const RunSpec& spec, const World& world,
                                       const System& frozen, const Trajectory& estimate,
                                       const SE3& truth_from_estimate, RandomStream noise,
                                       const EpisodeTools& tools) {
  tools.status("the robot's map");
  const RobotMap map = map_of(spec, world, estimate, noise);
  const auto run = [&](const VariantPlace& variant, const EpisodeStart& start,
                       const EpisodeObserver& observe) {
    return run_episode({.scene = variant.scene,
                        .robot = world.simulated->robot,
                        .level = variant.level,
                        .labels = spec.map_labels.mode,
                        .system_sees_labels = spec.labels != Labels(),
                        .map = map,
                        .frozen = frozen,
                        .map_of_system = estimate.empty() ? 0 : estimate.front().map,
                        .truth_from_estimate = truth_from_estimate,
                        .variant = variant.name,
                        .system_seed = spec.seed},
                       *spec.episodes, start, observe);
  };
  if (tools.only) {
    const VariantPlace& variant = world.variants.front();
    const EpisodeStart& start = variant.starts.at(tools.only->start);
    return {run(variant, start, tools.only->observer(map, start))};
  }
  std::vector<EpisodeScore> scores;
  for (const VariantPlace& variant : world.variants)
    for (const EpisodeStart& start : variant.starts) {
      tools.status(fmt::format("episode {} of {}", scores.size() + 1, spec.episodes->count()));
      const std::string key =
          text_key(fmt::format("{} {} {}", tools.key, variant.name, start.index));
      const std::string kept = tools.ended.get("episode", key, [&] {
        const EpisodeScore score = run(variant, start, {});
        tools.require_unchanged();
        return json_of(score).dump();
      });
      read_json(nlohmann::ordered_json::parse(kept), scores.emplace_back());
      tools.done();
    }
  return scores;
}

}  // namespace mh
