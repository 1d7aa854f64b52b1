// SPDX-License-Identifier: Apache-2.0
#include "bench/store/load_results.hpp"

#include <map>

#include "bench/suite/run_spec.hpp"

namespace mh {

BenchResults load_results(const Store& store, const Suite& suite) {
  return load_results(store, suite, store.planned_keys());
}

BenchResults load_results(const Store& store, const Suite& suite, const PlannedKeys& keys) {
  const std::map<std::string, std::string> key_of(keys.begin(), keys.end());
  BenchResults results;
  for (const RunSpec& spec : expand(suite)) {
    const auto key = key_of.find(spec.name);
    const auto status = key == key_of.end() ? std::nullopt : store.status(key->second);
    if (status == RunStatus::kDone)
      results.runs.push_back(store.load(key->second, spec));
    else if (status == RunStatus::kFailed)
      results.failed.push_back({spec, store.error(key->second)});
    else
      results.missing.push_back(spec.name);
  }
  return results;
}

}  // namespace mh
