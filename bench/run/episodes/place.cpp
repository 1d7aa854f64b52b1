// SPDX-License-Identifier: Apache-2.0
#include "bench/run/episodes/place.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "bench/protocol/mapping.hpp"
#include "bench/protocol/metrics/trajectory_score.hpp"
#include "bench/protocol/world/cached_light.hpp"
#include "bench/run/run_one.hpp"
#include "bench/suite/inputs.hpp"
#include "scenes/load.hpp"
#include "sim/motion/sensing.hpp"
#include "sim/physics/planar_world.hpp"
#include "sim/world/lit_scene.hpp"
#include "sim/world/pedestrian.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr std::uint64_t kTourStream = 0x746f7572;

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

/// What a variant reads beside its place.
struct VariantFiles {
  std::optional<Scene> scene;
  std::optional<Pedestrian> pedestrian;
  std::optional<SensorConfig> level;
};

/// @param inputs  receives the digests of what was read
VariantFiles load_files(const EpisodeVariant& variant, std::vector<InputDigest>& inputs) {
  const auto load = [&](const char* what, const auto& file, auto& loaded, const auto& by) {
    if (file) loaded = noted(inputs, fmt::format("{}: {}", variant.name, what), *file, by);
  };
  VariantFiles files;
  load("scene", variant.scene, files.scene, [&] { return load_scene(*variant.scene); });
  load("pedestrian", variant.pedestrian, files.pedestrian,
       [&] { return load_pedestrian(*variant.pedestrian); });
  load("level", variant.level, files.level, [&] { return load_sensor_config(*variant.level); });
  return files;
}

/// @param place  already has its mapping; receives the variant, and what was read for it
void add_variant(EpisodeWorld& place, const EpisodeVariant& variant, const EpisodesSpec& episodes,
                 int threads, const Cache& cache, const Say& say) {
  VariantFiles files = load_files(variant, place.inputs_of_variants);
  const SimulatedPlace& mapped = *place.world.simulated;
  VariantPlace made{.variant = variant,
                    .scene = {mapped.scene, mapped.renderer},
                    .level = mapped.sensors,
                    .starts = {}};
  if (files.scene) {
    light_from_cache(*files.scene, threads, cache, say);
    made.scene.scene = std::make_shared<const Scene>(*std::move(files.scene));
    made.scene.renderer = make_scene_renderer(*made.scene.scene);
  }
  require_level_floor(*made.scene.scene);
  if (files.pedestrian)
    made.scene.pedestrian =
        make_pedestrian_scene(*made.scene.scene, made.scene.renderer, *files.pedestrian);
  if (files.level) {
    made.level = *files.level;
    made.level.lens_distortion = mapped.sensors.lens_distortion;  // the camera stays the same one
  }
  made.starts = draw_starts(episodes, *made.scene.scene, mapped.robot);
  place.variants.push_back(std::move(made));
}

}  // namespace

EveryNth::EveryNth(std::shared_ptr<const Sequence> all, std::size_t n)
    : all_(std::move(all)), n_(n), camera_(all_->camera()) {
  camera_.rate_hz /= static_cast<double>(n);
  if (all_->truth() == nullptr) return;
  for (std::size_t i = 0; i < all_->truth()->size(); i += n) truth_.push_back((*all_->truth())[i]);
}

std::vector<InputDigest> read_variants(const EpisodesSpec& episodes) {
  std::vector<InputDigest> inputs;
  for (const EpisodeVariant& variant : episodes.variants) load_files(variant, inputs);
  return inputs;
}

void require_goals(const RunSpec& spec, const EpisodesSpec& episodes) {
  const Robot robot = load_robot(spec.environment.robot);
  require_equipped(spec, robot);
  EpisodesSpec one = episodes;
  one.starts = 1;
  std::set<std::filesystem::path> seen;
  for (const EpisodeVariant& variant : episodes.variants) {
    const std::filesystem::path file = variant.scene.value_or(spec.environment.scene);
    if (!seen.insert(file).second) continue;
    const Scene scene =
        load_scene(file, nullptr, variant.scene ? SceneFrame{} : spec.environment.frame);
    require_level_floor(scene);
    draw_starts(one, scene, robot);
  }
}

EpisodeWorld build_episode_world(const RunSpec& spec, const EpisodesSpec& episodes, int threads,
                                 const Cache& cache, const Say& say) {
  EpisodeWorld place;
  place.labels = spec.labels.mode;
  place.ticks_per_frame = episodes.ticks_per_frame;
  place.world = build_world(spec, threads, cache, say);
  const Robot& robot = place.world.simulated->robot;
  require_equipped(spec, robot);
  place.mapping = std::make_shared<EveryNth>(place.world.mapping,
                                             static_cast<std::size_t>(episodes.ticks_per_frame));
  place.world.mapping = place.mapping;  // systems are made for a camera of that rate
  for (const EpisodeVariant& variant : episodes.variants) {
    add_variant(place, variant, episodes, threads, cache, say);
    place.variants.back().level = with_dials(place.variants.back().level, spec.labels);
  }
  return place;
}

namespace {

/// Forwards frames without their labels.
class Unlabeled : public Sequence {
 public:
  explicit Unlabeled(const Sequence& inner) : inner_(inner) {}
  const Camera& camera() const override { return inner_.camera(); }
  std::size_t size() const override { return inner_.size(); }
  Stamp stamp_ns(std::size_t i) const override { return inner_.stamp_ns(i); }
  RgbdFrame frame(std::size_t i, RandomStream noise) const override {
    RgbdFrame frame = inner_.frame(i, noise);
    frame.semantics = {};
    return frame;
  }
  const Trajectory* truth() const override { return inner_.truth(); }

 private:
  const Sequence& inner_;
};

}  // namespace

MappedSystem map_tour(const RunSpec& spec, const EpisodeWorld& place, const MapTools& tools) {
  const Sequence& frames = *place.mapping;
  const RandomStream stream = RandomStream(spec.seed).fork(kTourStream);
  MappedSystem mapped;
  mapped.system = make_system(spec, place.world, tools.folder, tools.hidden);
  const Unlabeled unlabeled(frames);
  double furthest = 0;
  const auto map_now = [&] {
    tools.say(fmt::format("{}: maps the tour", spec.name));
    map_sequence(*mapped.system,
                 spec.system.sees_labels() ? frames : static_cast<const Sequence&>(unlabeled),
                 spec.protocol, stream,
                 [&](const MappedFrame& call, const RgbdFrame&, const SystemReport&) {
                   const double share =
                       static_cast<double>(call.index + 1) / static_cast<double>(frames.size());
                   if (share > furthest) tools.progress(furthest = share);
                 });
    mapped.system->freeze();
  };
  if (spec.system.saves_map()) {
    bool made = false;
    const std::string kept = tools.maps.get("episode-map", tools.key, [&] {
      map_now();
      made = true;
      return mapped.system->save();
    });
    if (!made) {
      mapped.system->restore(kept);
      mapped.system->freeze();
    }
  } else {
    map_now();
  }
  const Trajectory estimate = mapped.system->trajectory();
  mapped.offered = offered_frames(frames.size(), spec.protocol).size();
  mapped.tracked = estimate.size();
  if (estimate.empty()) return mapped;
  mapped.truth_from_estimate = frames_of(estimate, *frames.truth()).truth_from_estimate;
  const SimulatedPlace& simulated = *place.world.simulated;
  PlanarWorld seen(*simulated.scene, simulated.robot, Eigen::Vector2d::Zero(), 0);
  mapped.map = build_robot_map(
      {.frames = frames,
       .estimate = estimate,
       .robot = simulated.robot,
       .noise = mapping_noise(stream, 0),
       .lasers = [&](std::size_t i) {
         const SE3& world_from_base =
             simulated.mapping.base[i * static_cast<std::size_t>(place.ticks_per_frame)]
                 .world_from_camera;
         return read_ranges(seen, *simulated.robot.equipment, world_from_base).lasers_m;
       }});
  return mapped;
}

}  // namespace mh
