// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "bench/suite/runs.hpp"

namespace mh {

/// Everything about a run, with paths unchanged: the input of a separate process. Its keys are
/// those of the lists of fields (bench/suite/json_fields.hpp).
nlohmann::ordered_json to_json(const RunSpec& spec);

/// The inverse. @throws InputError if the JSON was not created by to_json.
RunSpec run_spec_from_json(const nlohmann::ordered_json& json);

}  // namespace mh
