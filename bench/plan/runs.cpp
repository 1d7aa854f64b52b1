// SPDX-License-Identifier: Apache-2.0
#include "bench/plan/runs.hpp"

#include <fmt/format.h>

namespace mh {

std::vector<RunSpec> expand(const Suite& suite) {
  std::vector<RunSpec> runs;
  const auto add = [&](SystemKind system, LabelMode labels, std::size_t level, int trial) {
    const std::string what = system == SystemKind::kPlain
                                 ? std::string(name(system))
                                 : fmt::format("{}-{}", name(system), name(labels));
    runs.push_back({system, labels, level, trial,
                    fmt::format("{}-{}-{}", what, level_name(suite.levels[level]), trial)});
  };
  for (std::size_t level = 0; level < suite.levels.size(); ++level)
    for (int trial = 0; trial < suite.trials; ++trial)
      for (const SystemKind system : suite.systems) {
        if (system == SystemKind::kPlain) {
          add(system, LabelMode::kNone, level, trial);
          continue;
        }
        for (const LabelMode labels : suite.labels) add(system, labels, level, trial);
      }
  return runs;
}

}  // namespace mh
