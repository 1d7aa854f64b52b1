// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "bench/protocol/mapping.hpp"
#include "bench/protocol/world/world.hpp"
#include "bench/suite/run_spec.hpp"

namespace mh {

/// One run, as a command orders it from a separate process (`modelhouse run-child FILE`, where FILE
/// is this struct as JSON). Only the spec affects the bits of the result.
struct RunOrder {
  RunSpec spec;
  std::string key;
  std::filesystem::path store, folder;
  std::filesystem::path cache;   ///< for baked light; empty: nothing is kept
  std::filesystem::path maps;    ///< for finished maps; empty: nothing is kept
  std::filesystem::path images;  ///< for images that several runs see; empty: none are shared
  std::uint64_t images_limit = 0;
  bool share_noise = false;   ///< also share mapping frames in `images`, noise included
  std::string views;          ///< file name of the environment's contact sheet
  std::string session_start;  ///< time at which the command started
  int jobs = 1;               ///< number of parallel runs, and of threads for baking light
  bool metrics_only = false;  ///< as in BenchOptions
  int live_port = 0;          ///< port on which the run is shown while it maps; 0: nowhere
  int parent = 0;  ///< process id of the command; when it ends, the run is killed; 0: none
};

template <MaybeConst<RunOrder> O, class Visit>
void fields(O& order, Visit& v) {
  auto& [spec, key, store, folder, cache, maps, images, images_limit, share_noise, views,
         session_start, jobs, metrics_only, live_port, parent] = order;
  v("spec", spec);
  v("key", key);
  v("store", store);
  v("folder", folder);
  v("cache", cache);
  v("maps", maps);
  v("images", images);
  v("images_limit", images_limit);
  v("share_noise", share_noise);
  v("views", views);
  v("session_start", session_start);
  v("jobs", jobs);
  v("metrics_only", metrics_only);
  v("live_port", live_port);
  v("parent", parent);
}

void write_order(const std::filesystem::path& file, const RunOrder& order);
/// @throws InputError unless the file has the form that write_order() writes.
RunOrder read_order(const std::filesystem::path& file);

/// Receives a run's progress.
struct RunListener {
  std::function<void(std::string_view)> say = [](std::string_view) {};
  std::function<void(double)> progress = [](double) {};
  std::function<void(std::string_view)> status = [](std::string_view) {};  ///< as in RunTools
  /// Called for each mapped frame; may be empty.
  std::function<void(const World&, const MappedFrame&, const RgbdFrame&, const SystemReport&)>
      observe = {};
};

/// Does one run in this process from start to end: builds its world, executes it, writes its files
/// into `folder` / its name, and puts the result into the store.
void execute_run(const RunOrder& order, const RunListener& listener);

}  // namespace mh
