// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/spec_json.hpp"

#include <fmt/format.h>

#include "bench/suite/json_fields.hpp"
#include "slam/config/slam.hpp"
#include "slam/io/error.hpp"
#include "slam/io/json_text.hpp"

namespace mh {

nlohmann::ordered_json to_json(const RunSpec& spec) {
  return json_of(spec);
}

RunSpec run_spec_from_json(const nlohmann::ordered_json& json) {
  try {
    RunSpec spec;
    read_json(json, spec);
    return spec;
  } catch (const nlohmann::ordered_json::exception& error) {
    throw InputError(fmt::format("run description: {}", json_fault(error)));
  }
}

}  // namespace mh
