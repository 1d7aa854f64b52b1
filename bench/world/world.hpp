// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/plan/suite.hpp"
#include "robots/model/robot.hpp"
#include "scenes/scene.hpp"
#include "sim/motion/motion.hpp"
#include "sim/render/renderer.hpp"
#include "sim/sensors/sensors.hpp"
#include "slam/vocabulary/vocabulary.hpp"

namespace mh {

/// xxh3-64 of the content of a file that the results depend on.
struct InputDigest {
  std::string name;  ///< suite, scene, robot, ..., `level pepper`
  std::uint64_t digest = 0;
};

/// What every run of a suite shares, built once and then only read.
struct World {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Renderer> renderer;
  Robot robot;
  DrivenPath mapping;
  std::optional<DrivenPath> second;  ///< the second tour, where the suite has one
  std::shared_ptr<const Vocabulary> vocabulary;
  std::vector<SensorConfig> levels;   ///< as Suite::levels
  std::optional<std::size_t> frames;  ///< where the tours were cut to so many frames
  std::vector<InputDigest> inputs;
};

/// Told what is being done, one short line each.
using Say = std::function<void(std::string_view)>;

/// Keeps the first frames of a path with their length; the other measures, which need the whole
/// drive, become NaN. @returns whether anything was cut off
bool cut(DrivenPath& path, std::size_t max_frames);

/// Bakes the light of a scene that has lamps but no baked light.
void light_scene(Scene& scene, int threads);

/// A scene ready to be looked at: loaded and lit. @throws InputError naming file and place.
Scene load_lit_scene(const std::filesystem::path& file, int threads);

/// A renderer with the exposure that suits the scene; one that shows its own colours unlit is shown
/// as it is.
std::unique_ptr<Renderer> make_scene_renderer(const Scene& scene);

/// Loads scene, robot, vocabulary and levels, bakes the light, drives both tours.
/// @param max_frames  cuts the mapping tour after so many frames (the second tour likewise)
/// @throws InputError if a file is bad or a tour cannot be driven.
World build_world(const Suite& suite, std::optional<std::size_t> max_frames, int threads,
                  const Say& say);

}  // namespace mh
