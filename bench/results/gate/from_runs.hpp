// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/protocol/run_result.hpp"
#include "bench/results/gate/figures.hpp"
#include "bench/suite/inputs.hpp"

namespace mh {

/// Returns what the gate records of a run.
RunFigures figures(const RunResult& run);
std::vector<RunFigures> figures(std::span<const RunResult> runs);

/// Digest of what the runs of a suite consist of: places (by the content of all files read for
/// them), systems, labels, seeds and protocol. What a change under test may alter (the method's
/// settings, the vocabulary, tolerances) is excluded.
/// @param inputs  reads the files, or has already read them for the same runs, so that the digest
/// and the runs use the same contents
std::string gate_suite_digest(const Suite& suite, InputReader& inputs);

/// Settings that may change in the same commit as the program: the section `slam`, systems' own
/// settings, the digests of the vocabulary and of the files of outside programs. If these differ,
/// different bits are expected.
nlohmann::ordered_json gate_settings(const Suite& suite, InputReader& inputs);

/// Program and machine: digest of the executable, processor model, and the CPU features by which
/// libraries choose their instructions.
nlohmann::ordered_json gate_origin();

}  // namespace mh
