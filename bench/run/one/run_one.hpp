// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "bench/protocol/run_result.hpp"
#include "bench/protocol/system.hpp"
#include "bench/protocol/world/world.hpp"
#include "bench/run/one/ask_episodes.hpp"

namespace mh {

/// The log of what a run's outside program prints, in the run's folder.
inline constexpr const char* kOutsideLog = "outside.log";

/// The system of a run: our own SLAM with the run's settings, or an outside one that exchanges
/// messages with us. Null for an outside program that processes a folder of recorded frames
/// instead.
/// @param folder  where the log of an outside program is written
/// @param hidden  as in RunTools
/// @throws InputError if settings are out of range; OutsideError if the program does not start.
std::unique_ptr<System> make_system(const RunSpec& spec, const World& world,
                                    const std::filesystem::path& folder,
                                    const std::vector<std::filesystem::path>& hidden = {});

/// What a run receives in addition to its spec and world; only `system`, `occupancy` and
/// `episodes.only` can change a result.
struct RunTools {
  std::filesystem::path folder = ".";  ///< exists; an outside program's files go there
  std::vector<std::filesystem::path> hidden =
      {};  ///< output folder and cache: no outside program sees them
  /// Receives the share of the work that is done, in [0, 1]; a rewind does not reduce it.
  std::function<void(double)> progress = [](double) {};
  /// Receives the status of the mapping after each frame: "frame 120 of 4490, 2 restarts, lost".
  std::function<void(std::string_view)> status = [](std::string_view) {};
  /// Makes the system instead of make_system(): for tests.
  std::function<std::unique_ptr<System>(const RunSpec&, const World&)> system = {};
  MappingObserver observe = {};  ///< called for each mapped frame
  std::size_t first = 0;         ///< earlier frames were already mapped, by this same system
  bool occupancy = true;         ///< if false, the result has no volume and an empty grid
  Cache maps = Cache();  ///< finished maps of the same mapping are loaded from and stored here
  EpisodeTools episodes = {};  ///< where scores are kept and which to run; run_one() sets the rest
};

/// Executes one run from the first frame to the last query: maps the tour, freezes, scores the
/// trajectory, builds the occupancy map, makes the queries under each parameter point, runs the
/// episodes.
/// @throws InputChanged if a file that it reads on demand was changed since the world was built;
/// then neither the run's map nor its result is kept.
RunResult run_one(const RunSpec& spec, const World& world, const RunTools& tools);

}  // namespace mh
