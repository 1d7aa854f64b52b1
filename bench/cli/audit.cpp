// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/audit/write.hpp"
#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/finish.hpp"
#include "bench/cli/progress.hpp"
#include "bench/cli/set_option.hpp"
#include "bench/cli/write_audit.hpp"
#include "bench/run/signal_watch.hpp"
#include "bench/store/store.hpp"
#include "bench/suite/cache.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/json_text.hpp"

namespace mh::cli {
namespace {

struct AuditArguments {
  std::string suite, out, cache;
  std::optional<int> trials;
  std::optional<std::size_t> frames;
  SetOption set;
  bool no_cache = false, json = false;
};

void run(AuditArguments options) {
  interrupts_go_on();
  resolve(options.suite, Shipped::kSuite);
  SuiteOverrides overrides;
  overrides.set = options.set.values();
  overrides.trials = options.trials;
  overrides.max_frames = options.frames;
  const Suite suite = load_suite(options.suite, overrides);
  const std::filesystem::path out = options.out.empty()
                                        ? std::filesystem::path("out") / (suite.name + "-audit")
                                        : std::filesystem::path(options.out);
  const OutputFolder folder(out, "audit", names_of_audit());

  std::optional<std::filesystem::path> cache;
  if (!options.no_cache) {
    cache =
        options.cache.empty() ? Cache::default_folder() : std::filesystem::absolute(options.cache);
    if (cache->empty()) cache.reset();
  }
  const WrittenAudit written = write_audit(out, suite, cache);
  if (options.json)
    fmt::print("{}", written.json);
  else
    fmt::print("{}\naudit.json, audit.csv, audit.txt in {}\n", written.text, out.string());
}

}  // namespace

std::vector<std::string> names_of_audit() {
  return {"audit.json", "audit.csv", "audit.txt"};
}

namespace {

/// The planned runs of the results in a folder; nullopt if the folder has no results.
std::optional<PlannedKeys> runs_of_results(const std::filesystem::path& out) {
  const std::filesystem::path file = out / "results.sqlite";
  if (!std::filesystem::exists(file)) return std::nullopt;
  return Store(file).planned_keys();
}

}  // namespace

void forget_other_audit(const std::filesystem::path& out) {
  const std::filesystem::path file = out / "audit.json";
  const auto runs = runs_of_results(out);
  if (!runs || !std::filesystem::exists(file)) return;
  const auto json = parse_json_or_discard<nlohmann::ordered_json>(read_file(file));
  if (!json.is_object() || !json.contains("definitions")) return;  // not written by this program
  nlohmann::ordered_json same = nlohmann::ordered_json::object();
  for (const auto& [name, key] : *runs) same[name] = key;
  if (json.value("runs", nlohmann::ordered_json()) == same) return;
  for (const std::string& name : names_of_audit()) std::filesystem::remove(out / name);
  fmt::print(stderr, "{}: removed audit.json, audit.csv and audit.txt: they belong to other runs\n",
             out.string());
}

WrittenAudit write_audit(const std::filesystem::path& out, const Suite& suite,
                         const std::optional<std::filesystem::path>& cache) {
  Progress progress("audit");
  AuditOptions how;
  how.cache = cache;
  how.planned = [&](const PlannedKeys& keys) {
    if (const auto runs = runs_of_results(out); runs && *runs != keys)
      throw InputError(
          fmt::format("{}: holds results of runs that {} no longer has: an audit belongs beside "
                      "its own results (`bench --audit`), or into another --out",
                      out.string(), suite.file.string()));
  };
  how.say = [&](std::string_view stage) { progress.say(stage); };
  how.progress = [&](double share, std::string_view status) { progress.share(share, status); };
  const std::vector<AuditedRun> audited = audit_suite(suite, how);
  progress.end();
  WrittenAudit made{audit_text(suite, audited), audit_json(suite, audited).dump(2) + "\n"};
  write_atomically(out / "audit.json", made.json);
  write_atomically(out / "audit.csv", audit_csv(audited));
  write_atomically(out / "audit.txt", made.text);
  return made;
}

void add_audit(CLI::App& app) {
  auto options = std::make_shared<AuditArguments>();
  CLI::App* command = app.add_subcommand("audit",
                                         "Explains why queries fail: checks a suite's matches and "
                                         "candidates against the exact truth.");
  command->add_option("suite", options->suite, "Suite: a file (YAML), or the name of a shipped one")
      ->required();
  command->add_option("--out", options->out, "Folder for the tables (default: out/<suite>-audit)");
  command
      ->add_option("--trials", options->trials,
                   "Repeats with seeds 0 .. N-1 (default: the suite's)")
      ->check(CLI::Range(1, 1000));
  command
      ->add_option("--frames", options->frames,
                   "Cuts the tours after N frames, for a quick look (default: all)")
      ->check(CLI::Range(1, 100000000));
  options->set.add_to(*command);
  command->add_option("--cache", options->cache,
                      "Cache folder for expensive results (default: $XDG_CACHE_HOME/modelhouse)");
  command->add_flag("--no-cache", options->no_cache, "Rebuilds everything, caches nothing");
  command->add_flag("--json", options->json, "Prints audit.json instead of the tables");
  command->footer(
      "Example:\n  modelhouse audit model_house\n"
      "For simulated scenes and the systems `semantic` and `plain`; see docs/audit.md.");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
