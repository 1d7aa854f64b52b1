// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "bench/results/summary.hpp"

namespace mh {

/// A row per parameter point and system, then the points that answer most.
std::string sweep_table(const Suite& suite, std::span<const Row> rows);

}  // namespace mh
