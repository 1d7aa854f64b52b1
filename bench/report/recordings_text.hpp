// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "bench/protocol/run_result.hpp"
#include "bench/suite/suite.hpp"

namespace mh {

/// Notes on a suite's recordings, below its table: that all trials see the same noise; frames that
/// were skipped, and for which systems if not for all; frames without a true pose; second
/// recordings whose queries no system answers correctly, as if they were in another frame of
/// reference. Empty without recordings.
std::string recordings_text(const Suite& suite, std::span<const RunResult> runs);

}  // namespace mh
