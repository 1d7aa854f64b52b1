// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/protocol/metrics/query_summary.hpp"
#include "bench/protocol/world/cached_light.hpp"
#include "bench/protocol/world/graded.hpp"
#include "bench/protocol/world/variant.hpp"
#include "bench/suite/cache.hpp"
#include "bench/suite/place_facts.hpp"
#include "bench/suite/run_spec.hpp"
#include "robots/model/robot.hpp"
#include "scenes/scene.hpp"
#include "sim/motion/motion.hpp"
#include "sim/render/bake.hpp"
#include "sim/render/renderer.hpp"
#include "sim/sensors/labels.hpp"
#include "sim/sensors/sense.hpp"
#include "sim/simulation/lasers_along.hpp"
#include "sim/simulation/pedestrian.hpp"
#include "sim/simulation/shared_exposures.hpp"
#include "slam/core/sequence.hpp"
#include "slam/io/read_record.hpp"
#include "slam/vocabulary/vocabulary.hpp"

namespace mh {

/// A simulated place, lit, with its driven paths.
struct SimulatedPlace {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Renderer> renderer;
  Robot robot;
  DrivenPath mapping;
  std::vector<SE3> odom_from_camera;  ///< at `mapping`'s frames; empty unless the suite asks for it
  std::vector<ImuReading> imu;        ///< along `mapping`; empty unless the suite asks for it
  std::shared_ptr<const LasersAlong> lasers;  ///< along `mapping`; null if the suite uses none
  std::shared_ptr<const LasersAlong> query_lasers;  ///< along `query_tour`; likewise
  std::optional<DrivenPath> query_tour;             ///< the second tour, if the environment has one
  std::shared_ptr<const Scene> query_scene;  ///< the second tour's scene; null: the same scene
  std::shared_ptr<const Renderer> query_renderer;  ///< of that scene; null: the same renderer
  std::shared_ptr<const PedestrianScene>
      pedestrian_scene;  ///< with the pedestrian that walks during the mapping; null without one
  std::shared_ptr<const PedestrianScene> query_pedestrian_scene;  ///< during the second tour
  SensorConfig sensors;                                           ///< of the run's level
  GradedQueries graded;                                           ///< empty if the run has none
};

/// The environment of one run, built once and then only read.
struct World {
  std::shared_ptr<const Sequence> mapping;      ///< what is mapped
  std::shared_ptr<const Sequence> query_tour;   ///< what is queried in addition; or null
  std::shared_ptr<const Sequence> graded = {};  ///< graded queries, one per frame; or null
  std::optional<SimulatedPlace> simulated;  ///< what these are rendered from; absent for recordings
  std::vector<VariantPlace> variants = {};  ///< of the episodes; empty if there are none
  std::shared_ptr<const Vocabulary> vocabulary;
  /// The rolling shutter's readout time from the recordings' calibration, instead of the run's
  /// `track.readout_s`; if absent, the run's applies.
  std::optional<double> readout_s = {};
  bool cut = false;                     ///< the sequences were cut after RunSpec::max_frames
  std::vector<std::string> notes = {};  ///< PlaceFacts::notes
  std::vector<InputDigest> inputs;      ///< what was read to build the world, by name
  /// Files that are read again later: a recording's, the vocabulary's, an outside program's.
  ReadRecord held = {};
};

/// The sequence that a set's queries are frames of; null if there is none.
inline const Sequence* sequence_of(const World& world, QuerySet set) {
  return set == QuerySet::kHeldOut      ? world.mapping.get()
         : set == QuerySet::kSecondTour ? world.query_tour.get()
                                        : world.graded.get();
}

/// Rebuilds the sequences of a simulated world from its existing paths.
/// @param images  as in build_world()
void simulate(World& world, LabelMode labels, const SharedImages& images = {});

/// What results record about a world.
PlaceFacts facts(const World& world, const RunSpec& spec);

/// Loads scene, robot, vocabulary and level of a run, bakes the light, drives both tours, draws the
/// starts of episodes; or opens its recordings. With episodes, the mapped sequence has their frame
/// rate. Reports the baking of light through `say`, since baking takes long.
/// @param images  shared by all runs in this environment at this level, and by no others
/// @throws InputError if a file is bad or a tour cannot be driven.
World build_world(const RunSpec& spec, int threads, const Cache& cache, const Say& say,
                  const BakeWatch& baked = {}, const SharedImages& images = {});

}  // namespace mh
