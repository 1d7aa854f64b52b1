// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "bench/cli/commands.hpp"
#include "bench/live/live_watch.hpp"
#include "bench/run/execute_run.hpp"
#include "bench/run/run_process.hpp"
#include "bench/suite/shipped.hpp"

namespace mh::cli {

namespace {

/// Reports progress from the process of a run to the process that started it, on standard output in
/// the form that RunProcess reads.
class ToParent {
 public:
  void say(std::string_view stage) {
    fmt::print("{}\n", stage);
    std::fflush(stdout);
  }

  /// Sends the share of the work that is done, in steps of half a percent.
  void share(double share) {
    const int step = static_cast<int>(200 * share);
    if (step == last_step_) return;
    last_step_ = step;
    fmt::print("{:.4f}\n", share);
    std::fflush(stdout);
  }

  /// Sends a status. At most one is sent every 0.5 s, since frames pass faster than anyone can
  /// read, but a status with a different first word is sent at once.
  void status(std::string_view status) {
    constexpr auto kBetween = std::chrono::milliseconds(500);
    const auto now = std::chrono::steady_clock::now();
    const std::string word(status.substr(0, status.find(' ')));
    if (word == last_word_ && now - told_ < kBetween) return;
    told_ = now;
    last_word_ = word;
    fmt::print("{}{}\n", kStatusMark, status);
    std::fflush(stdout);
  }

 private:
  int last_step_ = -1;
  std::chrono::steady_clock::time_point told_;
  std::string last_word_;
};

/// Lets systems in Python run `from modelhouse import System, serve`.
void offer_python_package() {
  const char* const set = std::getenv("PYTHONPATH");
  const std::string more = set != nullptr && *set != 0 ? std::string(set) + ":" : "";
  setenv("PYTHONPATH", (more + (data_folder() / "python").string()).c_str(), 1);
}

}  // namespace

void add_run_child(CLI::App& app) {
  auto file = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("run-child", "One run of a suite: what `bench` starts for each.");
  command->group("");  // used only by `bench`, so not listed
  command->add_option("order", *file)->required();
  command->callback([file] {
    const RunOrder order = read_order(*file);
    if (order.parent != 0) die_with(order.parent);
    offer_python_package();
    ToParent parent;
    RunListener listener{.say = [&](std::string_view stage) { parent.say(stage); },
                         .progress = [&](double share) { parent.share(share); },
                         .status = [&](std::string_view status) { parent.status(status); }};
    std::optional<LiveWatch> watch;
    if (order.live_port != 0) {
      watch.emplace(order.live_port, order.spec);
      listener.observe = [&](const World& world, const MappedFrame& call, const RgbdFrame& frame,
                             const SystemReport& report) {
        watch->show(world, call, frame, report);
      };
    }
    execute_run(order, listener);
  });
}

}  // namespace mh::cli
