// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "bench/protocol/run_result.hpp"
#include "bench/results/gate/gate.hpp"

namespace mh {

/// The beginning of our JUnit XML; files that begin differently belong to other programs and are
/// left alone.
inline constexpr std::string_view kJunitHead =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- modelhouse check -->\n";

/// The gate's findings as text: each judged measure with its change, its tolerance and the smallest
/// detectable change; then what changed, by how much and where.
std::string gate_report(const GateResult& result, const std::string& suite);

/// The same as JSON.
nlohmann::ordered_json gate_json(const GateResult& result, const std::string& suite);

/// The same as JUnit XML: a suite per scenario, a case per system and measure, and a case for the
/// digests if they had to be equal.
std::string gate_junit(const GateResult& result, const std::string& suite);

/// JUnit XML of a gate that could not judge: an error per run that failed.
std::string failures_junit(std::span<const FailedRun> failed, const std::string& suite);

}  // namespace mh
