// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "bench/suite/suite.hpp"

namespace mh {

/// Returns a suite with all its settings resolved; paths are relative to its folder, however it was
/// named.
nlohmann::ordered_json suite_json(const Suite& suite);

}  // namespace mh
