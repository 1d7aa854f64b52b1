// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "bench/results/summary.hpp"

namespace mh {

/// Table of a suite of many places, in the form of the paper's Table 1: a row per category and
/// system, then how the systems differ over scenes.
std::string scenes_table(const Suite& suite, std::span<const Row> rows);

}  // namespace mh
