// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/results/rows.hpp"

namespace mh {

/// The results as text: first in the form of the paper's Table 2 next to its published numbers,
/// then everything that must be reported with them. A function of suite, seeds and binary: times
/// are in a separate table. Failed runs are noted at the row that they would belong to, with their
/// errors at the end; so are runs that have not been made yet.
std::string results_table(const Suite& suite, std::span<const RunResult> runs,
                          std::span<const FailedRun> failed = {},
                          std::span<const std::string> missing = {});

/// The part of it that fits on a screen, without the comparisons.
std::string results_screen(const Suite& suite, std::span<const RunResult> runs,
                           std::span<const FailedRun> failed = {},
                           std::span<const std::string> missing = {});

/// Lines that state whose rules relocalization follows, so that no figure appears without its
/// basis, and one line for each system with settings of its own.
std::vector<std::string> base_lines(const Suite& suite);

/// How long the systems took.
std::string times_table(const Suite& suite, std::span<const RunResult> runs);

}  // namespace mh
