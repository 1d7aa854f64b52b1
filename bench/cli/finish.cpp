// SPDX-License-Identifier: Apache-2.0
#include "bench/cli/finish.hpp"

#include <fmt/format.h>

#include "bench/counted.hpp"
#include "bench/results/json.hpp"
#include "bench/results/table.hpp"
#include "bench/results/write.hpp"
#include "slam/core/error.hpp"

namespace mh::cli {

void finish(const std::filesystem::path& out, const Suite& suite, const BenchResults& results,
            bool json) {
  const std::string table = write_results(out, suite, results.runs);
  if (json) {
    fmt::print("{}\n", results_json(suite, results.runs).dump(2));
  } else {
    fmt::print("{}\n", table);
    if (!results.runs.empty()) fmt::print("{}\n", times_table(suite, results.runs));
    if (results.missing > 0)
      fmt::print("missing, of other shards (modelhouse merge): {}\n",
                 counted(results.missing, "run"));
    fmt::print("results in {}\n", out.string());
  }
  if (results.failed.empty()) return;
  std::string others;
  if (results.failed.size() > 1) others = fmt::format(" (and {} more)", results.failed.size() - 1);
  throw MachineError(fmt::format("{}{} failed: {}; --retry-failed tries again",
                                 results.failed.front().run, others, results.failed.front().error));
}

}  // namespace mh::cli
