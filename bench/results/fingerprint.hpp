// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace mh {

/// Build and machine, since the last bits may depend on them: processor, compiler, build type and
/// the versions of the libraries that compute. Part of times.json, never of results.json.
nlohmann::ordered_json fingerprint_json();

}  // namespace mh
