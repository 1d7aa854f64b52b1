// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/cache/cache.hpp"
#include "bench/plan/runs.hpp"
#include "bench/results/run_result.hpp"
#include "robots/model/robot.hpp"
#include "scenes/scene.hpp"
#include "scenes/scene_frame.hpp"
#include "sim/motion/motion.hpp"
#include "sim/render/bake.hpp"
#include "sim/render/renderer.hpp"
#include "sim/sensors/labels.hpp"
#include "sim/sensors/sensors.hpp"
#include "sim/world/walker.hpp"
#include "slam/vocabulary/vocabulary.hpp"

namespace mh {

/// Where one run takes place, built once and then only read.
struct World {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Renderer> renderer;
  Robot robot;
  DrivenPath mapping;
  std::optional<DrivenPath> second;           ///< the second tour, where the environment has one
  std::shared_ptr<const Scene> second_scene;  ///< where it takes place; null: the same scene
  std::shared_ptr<const Renderer> second_renderer;  ///< of that scene, likewise
  std::shared_ptr<const WalkedScene> walked;        ///< who walks about during the mapping; or null
  std::shared_ptr<const Vocabulary> vocabulary;
  SensorConfig sensors;             ///< the level
  bool cut = false;                 ///< the tours were cut after RunSpec::max_frames
  std::vector<InputDigest> inputs;  ///< what was read to build it, by name
};

/// What results tell of it.
PlaceFacts facts(const World& world);

/// Told what is being done, one short line each, not beginning with a digit.
using Say = std::function<void(std::string_view)>;

/// Keeps the first frames of a path with their length; the other measures, which need the whole
/// drive, become NaN. @returns whether anything was cut off
bool cut(DrivenPath& path, std::size_t max_frames);

/// One path after the other, without a way between them: the stamps go on at the camera's rate.
DrivenPath joined(DrivenPath first, const DrivenPath& second, double rate_hz);

/// Gives a scene that has lamps but no baked light its light, from the cache where it is there.
/// @param say    told when the light has to be baked; may be empty
/// @param baked  told the share that is baked, from any thread but never from two at once; may be
///               empty
void light_scene(Scene& scene, int threads, const Cache& cache = Cache(), const Say& say = {},
                 const BakeWatch& baked = {});

/// A scene ready to be looked at: loaded and lit. @throws InputError naming file and place.
/// @param warnings, frame  as of load_scene
Scene load_lit_scene(const std::filesystem::path& file, int threads, const Cache& cache = Cache(),
                     const Say& say = {}, std::vector<std::string>* warnings = nullptr,
                     const SceneFrame& frame = {}, const BakeWatch& baked = {});

/// Whether boxes can be drawn in a scene, by a detector or exactly: that needs objects.
/// @returns a warning where it has some, but none of a class that a detector knows (COCO's); else
/// ""
/// @throws InputError where it has no objects, so that all would be background.
std::string check_labels(const Scene& scene, LabelMode labels);

/// A renderer with the exposure that suits the scene; one that shows its own colors unlit is shown
/// as it is.
/// @param renderer  see make_renderer
std::unique_ptr<Renderer> make_scene_renderer(const Scene& scene,
                                              std::string_view renderer = "embree");

/// The scene with somebody who walks through it, shown with the scene's exposure.
std::shared_ptr<const WalkedScene> make_walked_scene(const Scene& scene,
                                                     std::shared_ptr<const Renderer> renderer,
                                                     const Walk& walk);

/// Loads scene, robot, vocabulary and level of a run, bakes the light, drives both tours. Says what
/// takes long: baking.
/// @throws InputError if a file is bad or a tour cannot be driven.
World build_world(const RunSpec& spec, int threads, const Cache& cache, const Say& say,
                  const BakeWatch& baked = {});

}  // namespace mh
