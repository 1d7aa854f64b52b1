// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "bench/suite/suite.hpp"

namespace mh {

/// Returns a suite with all its settings resolved. Paths are relative to the suite's folder,
/// however the path of the suite was given.
nlohmann::ordered_json suite_json(const Suite& suite);

}  // namespace mh
