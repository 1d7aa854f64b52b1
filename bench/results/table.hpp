// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bench/results/summary.hpp"
#include "bench/world/world.hpp"

namespace mh {

/// The results as text: first in the form of the paper's Table 2 beside its published numbers, then
/// everything that DESIGN section 5 asks to be printed with them.
std::string results_table(const Suite& suite, const World& world,
                          const std::vector<RunResult>& runs);

}  // namespace mh
