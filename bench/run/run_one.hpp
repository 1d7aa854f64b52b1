// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>

#include "bench/protocol/system.hpp"
#include "bench/results/run_result.hpp"
#include "bench/world/world.hpp"

namespace mh {

/// Seam for the test of `verify`: may change a frame before the system sees it, or an answer before
/// anybody else does. Empty in every real run.
struct RunTamper {
  std::function<void(std::size_t index, RgbdFrame&)> frame;
  std::function<void(std::size_t call, SystemReport&)> report;  ///< of track calls
};

/// The system of a run: our own SLAM with the run's settings, or an outside program in
/// conversation; null for one that is run over a recorded folder instead.
/// @param folder  for the log of an outside program
/// @throws InputError if settings are out of range; OutsideError if the program does not start.
std::unique_ptr<System> make_system(const RunSpec& spec, const World& world,
                                    const std::filesystem::path& folder);

/// What a run is given beside its spec and world; but for `tamper` and `occupancy` none of it
/// changes a result.
struct RunTools {
  std::filesystem::path folder = ".";  ///< exists; an outside program's files go there
  /// Told how much of the work is done, in [0, 1]; a rewind takes nothing back.
  std::function<void(double)> progress = [](double) {};
  /// Told where the mapping stands after each frame: "frame 120 of 4490, 2 restarts, lost".
  std::function<void(std::string_view)> status = [](std::string_view) {};
  /// Makes the system in make_system()'s place: for tests.
  std::function<std::unique_ptr<System>(const RunSpec&, const World&)> system = {};
  MappingObserver observe = {};  ///< Told of each frame that is mapped
  std::size_t first = 0;         ///< frames before it were mapped already, by this very system
  RunTamper tamper = {};
  bool occupancy = true;  ///< false: RunResult::volume stays null and its grid empty
  Cache maps = Cache();   ///< a finished map of the same mapping is taken from here, or kept here
};

/// One run from the first frame to the last query: map the tour, freeze, score the trajectory, put
/// the queries under each parameter point, build the occupancy map.
RunResult run_one(const RunSpec& spec, const World& world, const RunTools& tools);

}  // namespace mh
