// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/audit/query_audit.hpp"
#include "bench/protocol/run_result.hpp"
#include "bench/protocol/world/world.hpp"
#include "bench/run/one/run_one.hpp"
#include "bench/suite/run_spec.hpp"
#include "slam/pipeline/slam.hpp"

namespace mh {

/// @throws InputError naming the run and the reason, if it has episodes, no match traces (an
/// outside system) or no exact truth (a recording).
void require_auditable(const RunSpec& spec);

/// Executes a run as run_one() does, and keeps its finished map.
/// @param frozen  receives the map, with the settings of the run's last point
RunResult run_with_map(const RunSpec& spec, const World& world, RunTools tools, SlamState& frozen);

/// Compares every query of a finished run with the truth of its scene. The system is queried again
/// separately: the run's result does not change.
/// @param frozen    from run_with_map(); has the settings of the last point afterward
/// @param progress  receives the share of the work that is done
/// @throws MachineError if the map does not answer as it did in the run.
RunAudit audit_run(
    const RunResult& run, const World& world, SlamState& frozen,
    const std::function<void(double)>& progress = [](double) {});

}  // namespace mh
