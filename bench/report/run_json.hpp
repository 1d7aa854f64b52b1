// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "bench/protocol/run_result.hpp"

namespace mh {

/// Everything that a run produced, except its times.
nlohmann::ordered_json run_json(const RunResult& run);
nlohmann::ordered_json run_json(const FailedRun& run);

}  // namespace mh
