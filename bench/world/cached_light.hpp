// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>

#include "bench/cache/cache.hpp"
#include "scenes/scene.hpp"
#include "sim/render/bake.hpp"

namespace mh {

/// Told what is being done, one short line each, not beginning with a digit.
using Say = std::function<void(std::string_view)>;

/// Gives a scene that has lamps but no baked light its light, from the cache where it is there.
/// @param say    told when the light has to be baked; may be empty
/// @param baked  as of bake_light
void light_from_cache(Scene& scene, int threads, const Cache& cache, const Say& say = {},
                      const BakeWatch& baked = {});

}  // namespace mh
