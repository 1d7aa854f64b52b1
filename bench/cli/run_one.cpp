// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "bench/cli/commands.hpp"
#include "bench/cli/to_parent.hpp"
#include "bench/run/execute_run.hpp"
#include "bench/run/run_process.hpp"

namespace mh::cli {

void add_run_one(CLI::App& app) {
  auto file = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("run-one", "One run of a suite: what `bench` starts for each.");
  command->group("");  // for bench alone: not listed
  command->add_option("order", *file)->required();
  command->callback([file] {
    const RunOrder order = read_order(*file);
    if (order.parent != 0) die_with(order.parent);
    ToParent parent;
    execute_run(order, {.say = [&](std::string_view stage) { parent.say(stage); },
                        .progress = [&](double share) { parent.share(share); },
                        .status = [&](std::string_view status) { parent.status(status); }});
  });
}

}  // namespace mh::cli
