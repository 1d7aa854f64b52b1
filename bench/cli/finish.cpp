// SPDX-License-Identifier: Apache-2.0
#include "bench/cli/finish.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bench/cli/write_audit.hpp"
#include "bench/report/graded_report.hpp"
#include "bench/report/pages/verdict.hpp"
#include "bench/report/results_json.hpp"
#include "bench/report/results_table.hpp"
#include "bench/report/sweep_chart.hpp"
#include "bench/report/write.hpp"
#include "bench/run/plan_runs.hpp"
#include "bench/suite/run_spec.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"

namespace mh::cli {
namespace {

/// The verdicts by the suite's measure: a line for each pair of systems and set of queries, with as
/// many lines as fit on a screen.
std::string findings_text(const Suite& suite, const std::vector<RunResult>& runs) {
  constexpr std::size_t kMost = 8;
  std::string text;
  std::size_t said = 0, more = 0;
  for (const Judged& j : judged(suite, make_rows(suite, runs))) {
    if (!j.comparison.in_family || j.comparison.what.measure != name(suite.measure)) continue;
    if (said == kMost) {
      ++more;
      continue;
    }
    ++said;
    text += fmt::format("  {} - {}: {}\n", suite.systems[j.systems.first].name,
                        suite.systems[j.systems.second].name, finding(suite, j));
  }
  if (more > 0) text += fmt::format("  and {} more in table.txt\n", more);
  return text.empty() ? text : "\n" + text;
}

}  // namespace

void finish(const std::filesystem::path& out, const Suite& suite, const BenchResults& results,
            bool json) {
  forget_other_audit(out);
  write_results(out, suite, results.runs, results.failed, results.missing);
  if (json) {
    fmt::print("{}\n", results_json(suite, results.runs, results.failed, results.missing).dump(2));
  } else {
    fmt::print(
        "{}{}\n{}: all figures in table.txt, times in times.txt; as pages: modelhouse report "
        "{}\n",
        results_screen(suite, results.runs, results.failed, results.missing),
        findings_text(suite, results.runs), out.string(), out.string());
  }
  throw_failures(results.failed, fmt::format("why: see {}", (out / "table.txt").string()),
                 "; --retry-failed tries again");
}

std::vector<std::string> names_written(const std::filesystem::path& out, const Suite& suite) {
  if (std::filesystem::exists(out / "results.sqlite")) return {};
  std::vector<std::string> names{"table.txt", "times.txt", "results.json", "times.json",
                                 "reproduction.json"};
  for (const Environment& e : suite.environments) names.push_back(views_name(suite, e));
  for (const auto& level : suite.levels)
    for (const Labels& labels : suite.labels) {
      if (suite.graded) names.push_back(graded_image_name(labels, level));
      if (parameter_points(suite).size() == 1) continue;
      for (const SystemSpec& system : suite.systems)
        names.push_back(sweep_image_name(system, labels, level));
    }
  for (const RunSpec& spec : expand(suite)) names.push_back(spec.name);
  return names;
}

void show(Progress& progress, const PoolProgress& suite) {
  std::string figures = fmt::format("{} done, {} failed", suite.done, suite.failed);
  if (!suite.status.empty()) figures += ", " + suite.status;
  progress.share(suite.share, figures, suite.to_go_s);
}

void throw_failures(const std::vector<FailedRun>& failed, const std::string& why,
                    const std::string& advice) {
  if (failed.empty()) return;
  std::string others;
  if (failed.size() > 1) others = fmt::format(" and {} more", failed.size() - 1);
  const std::string reported =
      fmt::format("{}{} failed; {}", failed.front().spec.name, others, why);
  if (std::all_of(failed.begin(), failed.end(),
                  [](const FailedRun& f) { return f.error.starts_with(kBadInputMark); }))
    throw InputError(reported);
  throw MachineError(reported + advice);
}

}  // namespace mh::cli
