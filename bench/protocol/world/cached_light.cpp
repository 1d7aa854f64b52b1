// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/world/cached_light.hpp"

#include <cstring>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "bench/suite/code_version.hpp"
#include "bench/suite/fingerprint.hpp"
#include "scenes/load.hpp"
#include "sim/simulation/lit_scene.hpp"
#include "slam/core/digest.hpp"
#include "slam/io/error.hpp"

namespace mh {

void light_from_cache(Scene& scene, int threads, const Cache& cache, const Say& say,
                      const BakeWatch& baked) {
  if (!scene.light.empty() || scene.lights.empty()) return;
  const BakeConfig config{.threads = threads};
  const std::string key = text_key(fmt::format(
      "{} {} {} {} {} {} {} {}", code_of_light(), fingerprint_json().dump(), hex(digest(scene)),
      config.samples, config.bounces, config.sun_samples, config.smoothing, config.seed));
  const std::string light = cache.get("light", key, [&] {
    if (say) say(fmt::format("baking the light of {}", scene.name));
    bake_light(scene, config, baked);
    return std::string(reinterpret_cast<const char*>(scene.light.data()),
                       scene.light.size() * sizeof(Eigen::Vector3f));
  });
  if (light.size() != scene.positions_m.size() * sizeof(Eigen::Vector3f))
    throw MachineError(fmt::format("{}: holds an entry that does not fit its key: remove it",
                                   cache.folder().string()));
  scene.light.resize(scene.positions_m.size());
  std::memcpy(static_cast<void*>(scene.light.data()), light.data(), light.size());
}

SimulatedScene load_simulated_scene(const std::filesystem::path& file, const Cache& cache,
                                    const Say& say, std::vector<std::string>* warnings) {
  constexpr int kThreads = 2;
  Scene loaded = load_scene(file, warnings);
  if (!loaded.floor.is_level_zero())
    throw InputError(fmt::format("{}: its floor is not at z = 0", loaded.name));
  light_from_cache(loaded, kThreads, cache, say);
  SimulatedScene scene;
  scene.scene = std::make_shared<const Scene>(std::move(loaded));
  scene.renderer = make_scene_renderer(*scene.scene);
  return scene;
}

}  // namespace mh
