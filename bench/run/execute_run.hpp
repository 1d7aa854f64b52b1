// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "sim/world/shared_exposures.hpp"

namespace mh {

/// One run in this process, start to end, as a process of the pool does it: builds its world,
/// executes it, writes its files into folder / its name, and puts it into the store.
struct SingleRunOptions {
  std::filesystem::path description;  ///< JSON of the RunSpec
  std::filesystem::path store, folder;
  std::filesystem::path cache;  ///< for baked light; empty: keeps nothing
  std::filesystem::path maps;   ///< for finished maps; empty: keeps nothing
  SharedImages images = {};     ///< of runs that see the same images
  bool share_noise = false;     ///< also shares mapping frames with their noise there
  std::string key;
  std::string views;          ///< file name of the environment's contact sheet
  std::string session_start;  ///< start of the command that issued this order
  int jobs = 1;               ///< parallel runs; threads for baking light
  bool metrics_only = false;  ///< as in BenchOptions
  std::function<void(std::string_view)> say = [](std::string_view) {};
  std::function<void(double)> progress = [](double) {};
  std::function<void(std::string_view)> status = [](std::string_view) {};  ///< as in RunTools
};
void execute_run(const SingleRunOptions& order);

}  // namespace mh
