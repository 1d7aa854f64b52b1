// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/world/world.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "bench/protocol/mapping.hpp"
#include "bench/protocol/world/cached_detections.hpp"
#include "bench/protocol/world/cached_light.hpp"
#include "bench/protocol/world/parts.hpp"
#include "bench/suite/inputs.hpp"
#include "bench/suite/recorded_camera.hpp"
#include "robots/model/odometry.hpp"
#include "scenes/load.hpp"
#include "sim/sensors/imu.hpp"
#include "sim/sensors/shutter.hpp"
#include "sim/simulation/faulty_sequence.hpp"
#include "sim/simulation/lit_scene.hpp"
#include "sim/simulation/simulated_sequence.hpp"
#include "sim/simulation/travel.hpp"
#include "slam/core/digest.hpp"
#include "slam/core/interpolate.hpp"
#include "slam/core/path_length.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

PathFacts facts(const DrivenPath& path) {
  const std::size_t frames = path.camera.size();
  return {frames,
          frames,
          path.length_m,
          path.turned_in_place_rad,
          path.contact_time_s,
          path.max_penetration_m};
}

PathFacts recorded_path(const Sequence& sequence) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  PathFacts path{.frames = sequence.size(),
                 .length_m = kUnknown,
                 .turned_in_place_rad = kUnknown,
                 .contact_time_s = kUnknown,
                 .max_penetration_m = kUnknown};
  const Trajectory* truth = sequence.truth();
  if (truth == nullptr) return path;
  path.length_m = path_length_m(*truth);
  for (std::size_t i = 0; i < sequence.size(); ++i)
    if (interpolated_pose(*truth, sequence.stamp_ns(i), kMaxTruthGap_ns)) ++path.true_poses;
  return path;
}

/// Facts that simulated places and recordings have in common.
PlaceFacts common_facts(const World& world) {
  PlaceFacts f;
  if (world.vocabulary) {
    f.vocabulary_digest = world.vocabulary->digest();
    f.vocabulary_words = world.vocabulary->size();
  }
  f.cut = world.cut;
  f.notes = world.notes;
  f.inputs = world.inputs;
  return f;
}

PlaceFacts recorded_facts(const World& world, const RunSpec& spec) {
  const auto digest_of = [&](const char* name) {
    const auto input = std::ranges::find(world.inputs, name, &InputDigest::name);
    return input == world.inputs.end() ? 0 : input->digest;
  };
  const auto truth = [](const Sequence& sequence) {
    return sequence.truth() ? digest(*sequence.truth()) : 0;
  };
  PlaceFacts f = common_facts(world);
  f.scene = split_sequence(spec.environment.sequence).second.stem().string();
  f.scene_digest = digest_of("sequence");
  f.path_digest = truth(*world.mapping);
  f.mapping = recorded_path(*world.mapping);
  if (!world.query_tour) return f;
  f.scene_digest = chained(f.scene_digest, digest_of("queries"));
  f.path_digest = chained(f.path_digest, truth(*world.query_tour));
  f.query_tour = recorded_path(*world.query_tour);
  return f;
}

}  // namespace

void simulate(World& world, LabelMode labels, const SharedImages& images) {
  const SimulatedPlace& p = *world.simulated;
  const auto sequence = [&](const char* name, const auto& renderer, const DrivenPath& path,
                            const auto& pedestrian_scene,
                            const std::shared_ptr<const LasersAlong>& lasers) {
    auto made = std::make_shared<SimulatedSequence>(renderer, p.robot.camera, path.camera,
                                                    p.sensors, labels, pedestrian_scene);
    if (!images.folder.empty()) made->share(images, name);
    if (lasers) made->set_lasers([lasers](std::size_t i) { return lasers->at(i); });
    return made;
  };
  const auto mapping = sequence("mapping", p.renderer, p.mapping, p.pedestrian_scene, p.lasers);
  mapping->set_odometry(p.odom_from_camera);
  mapping->set_imu(p.imu);
  world.mapping = with_feed_faults(mapping, p.sensors);
  if (p.query_tour)
    world.query_tour =
        with_feed_faults(sequence("second", p.query_renderer ? p.query_renderer : p.renderer,
                                  *p.query_tour, p.query_pedestrian_scene, p.query_lasers),
                         p.sensors);
  if (!p.graded.list.empty())
    world.graded = with_feed_faults(
        std::make_shared<GradedSequence>(p.query_renderer ? p.query_renderer : p.renderer,
                                         p.robot.camera, p.graded.list, p.sensors, labels),
        p.sensors);
}

PlaceFacts facts(const World& world, const RunSpec& spec) {
  if (!world.simulated) return recorded_facts(world, spec);
  const SimulatedPlace& place = *world.simulated;
  PlaceFacts f = common_facts(world);
  f.scene = place.scene->name;
  f.robot = place.robot.name;
  f.scene_digest = digest(*place.scene);
  f.path_digest = digest(place.mapping.camera);
  f.mapping = facts(place.mapping);
  if (place.query_scene) f.scene_digest = chained(f.scene_digest, digest(*place.query_scene));
  f.graded = place.graded.cells;
  if (place.query_tour) {
    f.query_tour = facts(*place.query_tour);
    f.path_digest = chained(f.path_digest, digest(place.query_tour->camera));
  }
  if (world.graded) f.path_digest = chained(f.path_digest, digest(*world.graded->truth()));
  return f;
}

namespace {

std::shared_ptr<const Vocabulary> load_vocabulary(const RunSpec& spec, World& world) {
  if (spec.vocabulary.empty()) return nullptr;
  const ReadScope scope;
  const auto vocabulary =
      std::make_shared<const Vocabulary>(noted(world.inputs, "vocabulary", spec.vocabulary,
                                               [&] { return Vocabulary::load(spec.vocabulary); }));
  world.held.append(scope.record());  // the vocabulary is a view of its file
  return vocabulary;
}

/// Opens the recordings of a run, and records all inputs except those of an outside program.
World open_recordings(const RunSpec& spec) {
  const Environment& e = spec.environment;
  World world;
  const SensorConfig level =
      with_doses(spec.level.is_file() ? noted(world.inputs, "level", spec.level.file,
                                              [&] { return load_sensor_config(spec.level.file); })
                                      : exact_sensors(),
                 spec.level.doses);
  const auto open = [&](const char* name, const std::string& sequence) {
    Settings calibration;
    OpenedRecording opened = noted(world.inputs, name, split_sequence(sequence).second, [&] {
      return open_recorded(e, sequence, spec.labels == LabelMode::kRecorded, &calibration);
    });
    if (const double readout_s = calibration.slam.track.readout_s;
        readout_s > 0 && !e.suite_states_readout && !world.readout_s) {
      world.readout_s = readout_s;
      world.notes.push_back(fmt::format("track.readout_s: {:g}, from its calibration", readout_s));
    }
    for (const std::string& note : opened.notes)
      world.notes.push_back(without_place(note, sequence));
    const std::size_t all = opened.sequence->size();
    world.cut = world.cut || (spec.max_frames && *spec.max_frames < all);
    const bool gives_imu = std::ranges::count(spec.senses, Sense::kImu) > 0;
    if (gives_imu && opened.sequence->imu().empty())
      throw InputError(fmt::format(
          "{}: has no inertial sensor (imu.csv), but the suite uses one (`senses`)", sequence));
    std::shared_ptr<const Sequence> frames = first_frames(
        std::move(opened.sequence), spec.max_frames.value_or(all), std::nullopt, gives_imu);
    return level == exact_sensors() ? frames : degraded(std::move(frames), level);
  };
  world.mapping = open("sequence", e.sequence);
  if (e.queries) world.query_tour = open("queries", *e.queries);
  world.vocabulary = load_vocabulary(spec, world);
  return world;
}

/// Draws the graded queries of a run.
/// @pre the world has its scenes, robot and mapping path
GradedQueries graded_queries(const RunSpec& spec, const SimulatedPlace& world) {
  Trajectory offered;
  for (const std::size_t i : offered_frames(world.mapping.camera.size(), spec.protocol))
    offered.push_back(world.mapping.camera[i]);
  return draw_graded(
      *spec.graded,
      {.queried = world.query_scene ? *world.query_scene : *world.scene,
       .mapped_renderer = world.renderer,
       .queried_renderer = world.query_renderer ? world.query_renderer : world.renderer,
       .robot = world.robot,
       .offered = offered,
       .handheld = !is_driven(spec.environment.mapping_tour)});
}

/// Wheel odometry along a path, with the head's joints read without error.
/// @param lifted_ns  when the robot was carried to another place, if it was
std::vector<SE3> odometry_along(const DrivenPath& path, const Robot& robot,
                                std::optional<Stamp> lifted_ns, std::uint64_t seed,
                                const std::filesystem::path& file) {
  if (robot.wheels() == nullptr)
    throw InputError(
        fmt::format("{}: has no wheels, but the suite uses odometry (`senses`)", file.string()));
  WheelOdometer odometer(*robot.wheels(), robot.equipment->odometry, seed);
  std::vector<SE3> odom_from_camera;
  for (std::size_t i = 0; i < path.camera.size(); ++i) {
    const SE3& world_from_base = path.base[i].world_from_camera;
    if (i > 0 && lifted_ns && path.base[i - 1].stamp_ns < *lifted_ns &&
        path.base[i].stamp_ns >= *lifted_ns)
      odometer.lift_to(world_from_base);
    odom_from_camera.push_back(odometer.drive_to(world_from_base) * world_from_base.inverse() *
                               path.camera[i].world_from_camera);
  }
  return odom_from_camera;
}

void append(std::vector<ImuReading>& readings, const Trajectory& path, const SensorConfig& sensors,
            std::uint64_t seed) {
  const auto more = imu_along(path, sensors.imu, RandomStream(seed).fork(readings.size())).readings;
  readings.insert(readings.end(), more.begin(), more.end());
}

/// Builds the world, and records all inputs except those of an outside program.
World build(const RunSpec& spec, int threads, const Cache& cache, const Say& say,
            const BakeWatch& baked) {
  const Environment& environment = spec.environment;
  World world;
  SimulatedPlace& place = world.simulated.emplace();
  const auto input = [&](const char* name, const std::filesystem::path& source, auto&& load) {
    return noted(world.inputs, name, source, load);
  };
  const auto shorten = [&](DrivenPath& path) {
    if (spec.max_frames && cut(path, *spec.max_frames)) world.cut = true;
  };
  place.robot = input("robot", environment.robot, [&] { return load_robot(environment.robot); });
  world.vocabulary = load_vocabulary(spec, world);
  place.sensors =
      input("level", spec.level.file, [&] { return load_sensor_config(spec.level.file); });
  if (environment.sensors)
    place.sensors = input("sensors", *environment.sensors,
                          [&] { return load_sensor_config(*environment.sensors); });
  place.sensors = with_doses(place.sensors, spec.level.doses);
  place.sensors = with_dials(place.sensors, labels_of_frames(spec));
  place.robot.camera = with_lens(place.robot.camera, place.sensors);
  if (environment.kidnapped_tour)
    input("kidnapped_tour", *environment.kidnapped_tour,
          [&] { return load_tour(*environment.kidnapped_tour); });
  const auto walker = [&](const char* name, const std::optional<std::filesystem::path>& file) {
    return file ? std::optional(input(name, *file, [&] { return load_pedestrian(*file); }))
                : std::nullopt;
  };
  const std::optional<Pedestrian> pedestrian = walker("pedestrian", environment.pedestrian),
                                  query_pedestrian =
                                      walker("query_pedestrian", environment.query_pedestrian);

  const auto lit_scene = [&](const char* name, const std::filesystem::path& file) {
    Scene scene = input(name, file, [&] { return load_scene(file, nullptr, environment.frame); });
    light_from_cache(scene, threads, cache, say, baked);
    return std::make_shared<const Scene>(std::move(scene));
  };
  const auto scene = lit_scene("scene", environment.scene);
  place.scene = scene;
  place.renderer = make_scene_renderer(*scene);
  if (pedestrian)
    place.pedestrian_scene = make_pedestrian_scene(*scene, place.renderer, *pedestrian);

  const auto lose_frames = [&](DrivenPath& path) {
    const RandomStream same_for_every_trial(0);
    path.camera = arriving_frames(path.camera, place.sensors, same_for_every_trial);
    path.base = arriving_frames(path.base, place.sensors, same_for_every_trial);
  };
  const double rate_hz = place.robot.camera.rate_hz;
  const auto obstacles = [&](std::size_t frames_before) {
    std::vector<MovingObstacle> others;
    if (pedestrian)
      others.push_back(
          as_obstacle(*scene, *pedestrian, static_cast<double>(frames_before) / rate_hz));
    return others;
  };
  const auto along = [&](const Scene& in, const std::string& motion,
                         const std::vector<MovingObstacle>& others = {}) {
    DrivenPath path =
        hurried(travel(in, place.robot, motion, others), motion, place.sensors, rate_hz);
    if (say && !path.moved.empty()) say("warning: " + path.moved);
    return path;
  };
  place.mapping = input("mapping_tour", environment.mapping_tour,
                        [&] { return along(*scene, environment.mapping_tour, obstacles(0)); });
  const auto gives = [&](Sense sense) { return std::ranges::count(spec.senses, sense) > 0; };
  if (gives(Sense::kImu)) append(place.imu, place.mapping.camera, place.sensors, spec.seed);
  std::optional<Stamp> lifted_ns;
  if (environment.kidnapped_tour) {
    lifted_ns = place.mapping.camera.back().stamp_ns + 1;
    const DrivenPath elsewhere =
        along(*scene, *environment.kidnapped_tour, obstacles(place.mapping.camera.size()));
    const std::size_t before = place.mapping.camera.size();
    place.mapping = joined(std::move(place.mapping), elsewhere, rate_hz);
    if (gives(Sense::kImu))  // no readings while it is carried
      append(place.imu,
             {place.mapping.camera.begin() + static_cast<std::ptrdiff_t>(before),
              place.mapping.camera.end()},
             place.sensors, spec.seed);
  }
  lose_frames(place.mapping);
  shorten(place.mapping);
  if (gives(Sense::kOdometry))
    place.odom_from_camera =
        odometry_along(place.mapping, place.robot, lifted_ns, spec.seed, environment.robot);
  if (gives(Sense::kLaser))
    place.lasers = std::make_shared<const LasersAlong>(scene, place.robot, place.mapping, spec.seed,
                                                       obstacles(0));
  if (environment.query_scene) {
    place.query_scene = lit_scene("query_scene", *environment.query_scene);
    place.query_renderer = make_scene_renderer(*place.query_scene);
  }
  if (spec.graded) place.graded = graded_queries(spec, place);
  if (!environment.query_tour) return world;
  const Scene& queried = place.query_scene ? *place.query_scene : *scene;
  std::vector<MovingObstacle> met;
  if (query_pedestrian) {
    met.push_back(as_obstacle(queried, *query_pedestrian));
    place.query_pedestrian_scene = make_pedestrian_scene(
        queried, place.query_renderer ? place.query_renderer : place.renderer, *query_pedestrian);
  }
  place.query_tour = input("query_tour", *environment.query_tour,
                           [&] { return along(queried, *environment.query_tour, met); });
  lose_frames(*place.query_tour);
  shorten(*place.query_tour);
  if (gives(Sense::kLaser))
    place.query_lasers =
        std::make_shared<const LasersAlong>(place.query_scene ? place.query_scene : scene,
                                            place.robot, *place.query_tour, spec.seed + 1, met);
  return world;
}

/// Replaces the labels of all sequences with a detector's.
void add_detector(World& world, const DetectorSpec& spec, const Cache& cache, const Say& say) {
  const std::shared_ptr<const Detector> detector =
      noted(world.inputs, "detector", source_of(spec), [&] { return open_detector(spec); });
  for (std::shared_ptr<const Sequence>* sequence :
       {&world.mapping, &world.query_tour, &world.graded})
    if (*sequence != nullptr) {
      if (const std::string note = detector->check_frames(stamps_of(**sequence)); !note.empty())
        if (say) say("warning: " + note);
      *sequence = std::make_shared<DetectedSequence>(std::move(*sequence), detector,
                                                     spec.settings.fill, detections_in(cache));
    }
}

}  // namespace

World build_world(const RunSpec& spec, int threads, const Cache& cache, const Say& say,
                  const BakeWatch& baked, const SharedImages& images) {
  World world;
  if (spec.environment.is_recorded()) {
    const ReadScope scope;
    world = open_recordings(spec);
    world.held = scope.record();  // includes the files of the vocabulary
  } else {
    world = build(spec, threads, cache, say, baked);
  }
  const Labels& labels = labels_of_frames(spec);
  if (world.simulated) simulate(world, labels.mode, images);
  if (labels.detector) add_detector(world, *labels.detector, cache, say);
  if (spec.episodes) {
    world.variants = make_variants(spec, *world.simulated, world.inputs, [&](Scene& scene) {
      light_from_cache(scene, threads, cache, say, baked);
    });
    world.mapping =
        every_nth(world.mapping, static_cast<std::size_t>(spec.episodes->ticks_per_frame));
  }
  const ReadScope scope;
  std::ranges::move(inputs_of_program(spec.system), std::back_inserter(world.inputs));
  world.held.append(scope.record());
  std::ranges::sort(world.inputs, {}, &InputDigest::name);
  return world;
}

}  // namespace mh
