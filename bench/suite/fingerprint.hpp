// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace mh {

/// Compiler, build type and versions of the libraries that results depend on.
nlohmann::ordered_json build_json();

/// Build and machine, since the last bits may depend on them. It is part of the files that contain
/// times, and never part of results.json.
nlohmann::ordered_json fingerprint_json();

}  // namespace mh
