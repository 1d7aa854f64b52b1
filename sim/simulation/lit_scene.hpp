// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.hpp"
#include "scenes/scene_frame.hpp"
#include "sim/render/bake.hpp"
#include "sim/render/renderer.hpp"
#include "sim/simulation/pedestrian.hpp"

namespace mh {

/// Bakes the light of a scene that has lamps but no baked light.
/// @param baked  receives the baked share, from any thread but never from two at once; may be empty
void light_scene(Scene& scene, int threads, const BakeWatch& baked = {});

/// Returns a scene ready to be rendered: loaded and lit. @throws InputError naming file and place.
/// @param warnings, frame  as in load_scene
Scene load_lit_scene(const std::filesystem::path& file, int threads,
                     std::vector<std::string>* warnings = nullptr, const SceneFrame& frame = {},
                     const BakeWatch& baked = {});

/// Returns a renderer with an exposure that suits the scene; a scene with its own unlit colors is
/// shown as it is.
/// @param renderer  see make_renderer
std::unique_ptr<Renderer> make_scene_renderer(const Scene& scene,
                                              std::string_view renderer = "embree");

/// Returns the scene with a pedestrian, rendered with the scene's exposure.
std::shared_ptr<const PedestrianScene> make_pedestrian_scene(
    const Scene& scene, std::shared_ptr<const Renderer> renderer, const Pedestrian& pedestrian);

}  // namespace mh
