// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <memory>

#include "bench/cli/commands.hpp"
#include "bench/cli/to_parent.hpp"
#include "bench/run/execute_run.hpp"
#include "bench/run/run_process.hpp"

namespace mh::cli {
namespace {

struct RunOneArguments {
  std::string description, store, folder, cache, maps, images, views, key, session_start;
  std::uint64_t images_limit = 0;
  int jobs = 1;
  int parent = 0;
  bool metrics_only = false, share_noise = false;
};

void run(const RunOneArguments& options) {
  if (options.parent != 0) die_with(options.parent);
  ToParent parent;
  execute_run({.description = options.description,
               .store = options.store,
               .folder = options.folder,
               .cache = options.cache,
               .maps = options.maps,
               .images = {options.images, options.images_limit},
               .share_noise = options.share_noise,
               .key = options.key,
               .views = options.views,
               .session_start = options.session_start,
               .jobs = options.jobs,
               .metrics_only = options.metrics_only,
               .say = [&](std::string_view stage) { parent.say(stage); },
               .progress = [&](double share) { parent.share(share); },
               .status = [&](std::string_view status) { parent.status(status); }});
}

}  // namespace

void add_run_one(CLI::App& app) {
  auto options = std::make_shared<RunOneArguments>();
  CLI::App* command =
      app.add_subcommand("run-one", "One run of a suite: what `bench` starts for each.");
  command->group("");  // for bench alone: not listed
  command->add_option("description", options->description)->required();
  command->add_option("--store", options->store)->required();
  command->add_option("--key", options->key)->required();
  command->add_option("--folder", options->folder)->required();
  command->add_option("--cache", options->cache);
  command->add_option("--maps", options->maps);
  command->add_option("--images", options->images);
  command->add_option("--images-limit", options->images_limit);
  command->add_flag("--share-noise", options->share_noise);
  command->add_option("--views", options->views)->required();
  command->add_option("--session-start", options->session_start);
  command->add_option("--jobs", options->jobs);
  command->add_flag("--metrics-only", options->metrics_only);
  command->add_option("--parent", options->parent);
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
