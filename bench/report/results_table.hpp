// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/results/rows.hpp"

namespace mh {

/// The results as text: first in the form of the paper's Table 2 next to its published numbers,
/// then everything else that a report must include. The text depends only on suite, seeds and
/// binary; times are in a separate table. Failed runs are counted in the rows where they are
/// missing and are listed with their errors at the end, as are runs that have not been made yet.
std::string results_table(const Suite& suite, std::span<const RunResult> runs,
                          std::span<const FailedRun> failed = {},
                          std::span<const std::string> missing = {});

/// The part of results_table() that fits on a screen, without the comparisons.
std::string results_screen(const Suite& suite, std::span<const RunResult> runs,
                           std::span<const FailedRun> failed = {},
                           std::span<const std::string> missing = {});

/// One line that states whose rules relocalization follows (no figure is shown without it), and one
/// line for each system with settings of its own.
std::vector<std::string> base_lines(const Suite& suite);

/// The table of how much time the systems took.
std::string times_table(const Suite& suite, std::span<const RunResult> runs);

}  // namespace mh
