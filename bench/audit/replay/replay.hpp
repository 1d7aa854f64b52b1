// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>

#include <nlohmann/json.hpp>

#include "bench/protocol/run_result.hpp"
#include "bench/suite/cache.hpp"
#include "scenes/scene.hpp"

namespace mh {

/// Maximum size of a scene in a report: bytes of its script file.
inline constexpr std::size_t kMeshBytes = 3'000'000;

/// A scene for a browser: positions in 16 bits within its box, colors with baked light at its
/// vertices, triangles. Faces are split where texture or light shows, as finely as kMeshBytes
/// allows; a scene that is already too large is decimated (meshoptimizer).
nlohmann::ordered_json mesh_json(const Scene& scene);

/// What replays are made with.
struct ReplayTools {
  Cache cache;      ///< of light and finished maps
  int threads = 1;  ///< for baking light
  std::function<void(std::string_view)> say = [](std::string_view) {};
};

/// What a replay adds to a run's result.
struct Replay {
  nlohmann::ordered_json scene;  ///< mesh, landmarks with their classes, keyframes
  nlohmann::ordered_json views;  ///< views_json()
};

/// Executes a run again and records it. Runs repeat bit for bit; `same` in the scene states whether
/// this execution gave the same positions as the result. Orientations are not compared, since a
/// results file rounds them.
/// @throws InputError naming the run if it uses a recording or an outside system; InputChanged if a
/// file that it reads has changed since the result was made.
Replay make_replay(const RunResult& result, const ReplayTools& tools);

}  // namespace mh
