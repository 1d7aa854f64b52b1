// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "bench/results/rows.hpp"

namespace mh {

/// Table of a sweep: a row per parameter point and system, then the points with the most correct
/// answers.
std::string sweep_table(const Suite& suite, std::span<const Row> rows);

}  // namespace mh
