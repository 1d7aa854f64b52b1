// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "bench/results/summary.hpp"

namespace mh {

/// The results as text: first in the form of the paper's Table 2 beside its published numbers, then
/// everything that DESIGN section 5 asks to be printed with them.
/// A function of suite, seeds and binary: times stand in a table of their own.
/// Failed runs are told with the row that they would belong to, and why at the end; so are those
/// that nobody has made yet.
std::string results_table(const Suite& suite, std::span<const RunResult> runs,
                          std::span<const FailedRun> failed = {},
                          std::span<const std::string> missing = {});

/// How long the systems took.
std::string times_table(const Suite& suite, std::span<const RunResult> runs);

}  // namespace mh
