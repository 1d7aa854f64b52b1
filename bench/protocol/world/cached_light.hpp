// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>

#include "bench/suite/cache.hpp"
#include "scenes/scene.hpp"
#include "sim/render/bake.hpp"

namespace mh {

/// Receives what is being done, one short line each, not starting with a digit.
using Say = std::function<void(std::string_view)>;

/// Adds baked light to a scene that has lamps but none yet, from the cache if it is there.
/// @param say    called when the light has to be baked; may be empty
/// @param baked  as in bake_light
void light_from_cache(Scene& scene, int threads, const Cache& cache, const Say& say = {},
                      const BakeWatch& baked = {});

}  // namespace mh
