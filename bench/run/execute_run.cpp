// SPDX-License-Identifier: Apache-2.0
#include "bench/run/execute_run.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/protocol/streams.hpp"
#include "bench/protocol/world/world.hpp"
#include "bench/report/write.hpp"
#include "bench/run/one/run_one.hpp"
#include "bench/store/store.hpp"
#include "bench/suite/cache.hpp"
#include "bench/suite/inputs.hpp"
#include "bench/suite/json_fields.hpp"
#include "bench/suite/run_key.hpp"
#include "bench/systems/timed.hpp"
#include "slam/config/slam.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/json_text.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// Load average of the last minute, per processor; 0 if unknown.
double load_per_processor() {
  double load = 0;
  if (getloadavg(&load, 1) != 1) return 0;
  return load / std::max(1.0, static_cast<double>(sysconf(_SC_NPROCESSORS_ONLN)));
}

/// @param wall_s wall time of this process so far, the period that its cpu_s covers
/// @param world_s, products_s  CPU time spent on the world and on products, in addition to what
/// `run` recorded
RunCost cost_of_this_process(const RunResult& run, double wall_s, double world_s, double products_s,
                             const RunOrder& order) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return {.wall_s = wall_s,
          .cpu_s = processor_time_s(),
          .slam_s = run.times.processor_s,
          .frames_s = world_s + run.frames_s,
          .products_s = products_s + run.products_s,
          .max_rss_mb = static_cast<double>(usage.ru_maxrss) / 1024.0,
          .circumstances = {.host = {},
                            .session_start = order.session_start,
                            .jobs = order.jobs,
                            .load = load_per_processor()}};
}

/// Builds the world of a run. The command read every input before it started any run, so an input
/// that cannot be read now has changed.
World build_as_planned(const RunSpec& spec, const std::string& key,
                       const std::function<World()>& build) {
  try {
    return build();
  } catch (const InputChanged&) {
    throw;
  } catch (const InputError&) {
    try {
      InputReader now;
      require_key(spec, now.inputs_of(spec), key);
    } catch (const InputError&) {
      throw_changed(spec);
    }
  }
  return build();  // the inputs match the key, so an error now is the run's own fault
}

}  // namespace

void write_order(const fs::path& file, const RunOrder& order) {
  write_atomically(file, json_of(order).dump(1));
}

RunOrder read_order(const fs::path& file) {
  try {
    RunOrder order;
    read_json(nlohmann::ordered_json::parse(read_file(file)), order);
    return order;
  } catch (const nlohmann::ordered_json::exception& error) {
    throw InputError(fmt::format("{}: {}", file.string(), json_fault(error)));
  }
}

void execute_run(const RunOrder& order, const RunListener& listener) {
  const auto start = std::chrono::steady_clock::now();
  // To follow a frame through the code, start here: nothing before this point affects its bits
  // except the spec.
  const RunSpec& spec = order.spec;
  double world_s = 0, products_s = 0;
  const World world = build_as_planned(spec, order.key, [&] {
    const ProcessorTimer timer(world_s);
    const auto baked = [&](double share) {
      listener.status(fmt::format("light {:.0f} %", 100 * share));
    };
    SharedImages images{order.images, order.images_limit};
    if (order.share_noise) images.noises = shared_noises(spec);
    return build_world(spec, order.jobs, Cache(order.cache), listener.say, baked, images);
  });
  require_key(spec, world.inputs, order.key);
  const fs::path folder = order.folder / spec.name;
  const fs::path ended = folder / "episodes";
  make_output_folder(folder);
  if (!order.metrics_only) remove_run(folder);
  std::error_code no_matter;
  // If the system is not repeatable, its new map differs from the one that earlier episodes used,
  // so their scores are discarded.
  if (!spec.system.repeatable) fs::remove_all(ended, no_matter);
  MappingObserver observe;
  if (listener.observe)
    observe = [&](const MappedFrame& call, const RgbdFrame& frame, const SystemReport& report) {
      listener.observe(world, call, frame, report);
    };
  const RunResult run = run_one(spec, world,
                                {.folder = folder,
                                 .hidden = {order.folder, order.cache},
                                 .progress = listener.progress,
                                 .status = listener.status,
                                 .system = {},
                                 .observe = observe,
                                 .occupancy = !order.metrics_only,
                                 .maps = Cache(order.maps),
                                 .episodes = {.ended = Cache(ended), .key = order.key}});
  if (!order.metrics_only) {
    const ProcessorTimer timer(products_s);
    write_run(folder, world, run, order.key);
    // One process makes the contact sheet; if two processes make it, both write the same bytes.
    if (world.simulated) write_views(order.folder / order.views, world, spec);
  }
  const double wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Store(order.store)
      .put(order.key, run, cost_of_this_process(run, wall_s, world_s, products_s, order));
  fs::remove_all(ended, no_matter);
}

}  // namespace mh
