// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "bench/results/summary.hpp"

namespace mh {

/// The results as text: first in the form of the paper's Table 2 next to its published numbers,
/// then everything that must be reported with them. A function of suite, seeds and binary: times
/// are in a separate table. Failed runs are noted at the row that they would belong to, with their
/// errors at the end; so are runs that have not been made yet.
std::string results_table(const Suite& suite, std::span<const RunResult> runs,
                          std::span<const FailedRun> failed = {},
                          std::span<const std::string> missing = {});

/// How long the systems took.
std::string times_table(const Suite& suite, std::span<const RunResult> runs);

}  // namespace mh
