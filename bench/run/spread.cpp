// SPDX-License-Identifier: Apache-2.0
#include "bench/run/spread.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "bench/protocol/metrics/averages.hpp"
#include "bench/suite/shipped.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

/// Faults within what is published of usual cameras (bench/suites/stress.yaml).
const std::vector<Dose> kChanges = {{"feed.backward", 1}, {"feed.keep_every", 2},
                                    {"light.share", 0.7}, {"color_noise.sigma", 0.007},
                                    {"jpeg.loss", 20},    {"depth_faults.noise", 1}};

const RunResult* run_of(const BenchResults& results, const std::string& environment,
                        const std::string& system, const std::string& level) {
  for (const RunResult& run : results.runs)
    if (run.spec.environment.name == environment && run.spec.system.name == system &&
        level_name(run.spec.level) == level)
      return &run;
  return nullptr;
}

}  // namespace

std::vector<Spread> find_spread(const Suite& suite, const SuiteOverrides& overrides,
                                const StressOptions& options) {
  if (suite.levels.size() != 1 || suite.labels.size() != 1)
    throw InputError(fmt::format("{}: the spread is found at one level with one kind of labels",
                                 suite.file.string()));
  const Level unchanged = suite.levels.front();
  Suite changed = suite;
  changed.compare.clear();
  changed.trials = 1;
  for (const Dose& change : kChanges) {
    changed.levels.push_back(unchanged);
    changed.levels.back().doses.push_back(change);
  }
  Suite redrawn = suite;
  redrawn.compare.clear();
  redrawn.trials = 1;
  ++redrawn.seed;
  InputReader inputs(options.bench.say);
  BenchOptions bench = options.bench;
  bench.metrics_only = true;
  bench.inputs = &inputs;
  bench.say = [](std::string_view) {};
  const auto run = [&](const Suite& some, double done) {
    bench.progress = [&, done](const PoolProgress& p) {
      options.step(done + 0.5 * p.share, fmt::format("{} done", p.done));
    };
    BenchResults results = run_suite(some, overrides, bench);
    if (!results.failed.empty())
      throw InputError(
          fmt::format("{}: {}", results.failed.front().spec.name, results.failed.front().error));
    return results;
  };
  const BenchResults at_doses = run(changed, 0), other_draws = run(redrawn, 0.5);

  std::vector<Spread> all;
  for (const Environment& environment : suite.environments)
    for (const SystemSpec& system : suite.systems) {
      const RunResult* base =
          run_of(at_doses, environment.name, system.name, level_name(unchanged));
      if (base == nullptr) continue;
      Spread spread;
      spread.environment = environment.name;
      spread.system = system.name;
      spread.ate_rmse_m = base->trajectory.ate_rmse_m;
      const double offered = base->trajectory.offered;
      std::vector<std::optional<double>> moves_m;
      const auto add = [&](const std::string& name, const Trajectory& path, double frames) {
        spread.changes.push_back(moved(name, base->estimate, path, frames));
        moves_m.push_back(spread.changes.back().rmse_m);
      };
      if (const RunResult* again =
              run_of(other_draws, environment.name, system.name, level_name(unchanged)))
        add("other draws", again->estimate, offered);
      for (const Dose& change : kChanges) {
        Level level = unchanged;
        level.doses.push_back(change);
        const RunResult* made = run_of(at_doses, environment.name, system.name, level_name(level));
        if (made == nullptr) continue;
        const bool back = change.dial == "feed.backward";
        const std::vector<MappedFrame>& calls = base->mapping.calls;
        Stamp first_ns = 0, last_ns = 0;
        if (!calls.empty()) {
          const auto [low, high] = std::ranges::minmax(calls, {}, &MappedFrame::stamp_ns);
          first_ns = low.stamp_ns;
          last_ns = high.stamp_ns;
        }
        add(back ? "backward" : fmt::format("{} {:g}", change.dial, change.value),
            back ? turned_back(made->estimate, first_ns, last_ns) : made->estimate,
            made->trajectory.offered);
      }
      spread.median_m = median_of_known(moves_m);
      all.push_back(std::move(spread));
    }
  return all;
}

Suite suite_of_recording(const std::string& recording, const std::string& settings) {
  const auto [layout, path] = split_sequence(recording);
  const std::string whole = std::filesystem::absolute(path).lexically_normal().string();
  const std::string quoted = fmt::format("'{}{}'", layout.empty() ? "" : layout + ":", whole);
  std::string text = fmt::format(
      "name: spread\nenvironments:\n- {{category: recording, name: recording, sequence: {}{}}}\n"
      "vocabulary: vocabulary\nsystems: [plain]\nlabels: [none]\nprotocol: {{test_interval: 0}}\n",
      quoted,
      settings.empty()
          ? ""
          : fmt::format(", settings: '{}'", std::filesystem::absolute(settings).string()));
  return parse_suite(text, "spread");
}

}  // namespace mh
