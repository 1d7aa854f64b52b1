// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/suite/cache.hpp"
#include "scenes/scene.hpp"
#include "sim/render/bake.hpp"
#include "sim/simulation/simulation.hpp"

namespace mh {

/// Receives short lines about what is being done; none starts with a digit.
using Say = std::function<void(std::string_view)>;

/// Adds baked light to a scene that has lamps but no baked light yet; takes it from the cache if it
/// is there.
/// @param say    called when the light has to be baked; may be empty
/// @param baked  as in bake_light
void light_from_cache(Scene& scene, int threads, const Cache& cache, const Say& say = {},
                      const BakeWatch& baked = {});

/// Loads a place to drive in, with its light. @param warnings  as in load_scene
/// @throws InputError naming the file, also if its floor is not at z = 0.
SimulatedScene load_simulated_scene(const std::filesystem::path& file, const Cache& cache,
                                    const Say& say = {},
                                    std::vector<std::string>* warnings = nullptr);

}  // namespace mh
