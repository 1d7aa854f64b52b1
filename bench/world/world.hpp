// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/cache/cache.hpp"
#include "bench/plan/runs.hpp"
#include "bench/provenance/place_facts.hpp"
#include "bench/world/cached_light.hpp"
#include "robots/model/robot.hpp"
#include "scenes/scene.hpp"
#include "sim/motion/motion.hpp"
#include "sim/render/bake.hpp"
#include "sim/render/renderer.hpp"
#include "sim/sensors/labels.hpp"
#include "sim/sensors/sensors.hpp"
#include "sim/world/pedestrian.hpp"
#include "slam/core/sequence.hpp"
#include "slam/vocabulary/vocabulary.hpp"

namespace mh {

/// A simulated place, lit and driven through.
struct SimulatedPlace {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Renderer> renderer;
  Robot robot;
  DrivenPath mapping;
  std::optional<DrivenPath> second;           ///< the second tour, where the environment has one
  std::shared_ptr<const Scene> second_scene;  ///< where it takes place; null: the same scene
  std::shared_ptr<const Renderer> second_renderer;  ///< of that scene, likewise
  std::shared_ptr<const PedestrianScene>
      pedestrian_scene;  ///< with whoever is about during the mapping; or null
  SensorConfig sensors;  ///< the level
};

/// Where one run takes place, built once and then only read.
struct World {
  std::shared_ptr<const Sequence> mapping;  ///< what is mapped
  std::shared_ptr<const Sequence> second;   ///< what is asked about beside it; or null
  std::optional<SimulatedPlace> simulated;  ///< of what they are made; a recording has none
  std::shared_ptr<const Vocabulary> vocabulary;
  bool cut = false;                 ///< the sequences were cut after RunSpec::max_frames
  std::vector<InputDigest> inputs;  ///< what was read to build it, by name
};

/// Makes the sequences of a simulated world anew, of its paths as they are.
void simulate(World& world, LabelMode labels);

/// What results tell of it.
PlaceFacts facts(const World& world, const RunSpec& spec);

/// Loads scene, robot, vocabulary and level of a run, bakes the light, drives both tours; or opens
/// its recordings. Says what takes long: baking.
/// @throws InputError if a file is bad or a tour cannot be driven.
World build_world(const RunSpec& spec, int threads, const Cache& cache, const Say& say,
                  const BakeWatch& baked = {});

}  // namespace mh
