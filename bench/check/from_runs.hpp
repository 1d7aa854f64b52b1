// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/check/figures.hpp"
#include "bench/results/run_result.hpp"

namespace mh {

/// What the gate keeps of a run.
RunFigures figures(const RunResult& run);
std::vector<RunFigures> figures(std::span<const RunResult> runs);

/// Names what the runs of a suite are made of: places (by the content of all files that are read
/// for them), systems, labels, seeds and protocol. What a change under test may change (the
/// method's settings, the vocabulary, tolerances) is no part of it.
std::string gate_suite_digest(const Suite& suite);

/// What a change to the program may change along with it: the section `slam`, the digests of the
/// vocabulary and of what outside programs are made of. With other ones other bits are no wonder.
nlohmann::ordered_json gate_settings(const Suite& suite);

/// Program and machine: digest of the executable, processor and the features that libraries choose
/// their instructions by.
nlohmann::ordered_json gate_origin();

}  // namespace mh
