// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "bench/protocol/run_result.hpp"

namespace mh {

/// How the mapped frame nearest to a query is found: by time for a held-out frame, by place for
/// others.
NearestBy nearest_by(QuerySet set);

/// Where an answer is in the frame of the truth: relative to the nearest mapped frame, as it was
/// scored (docs/protocol.md), so that its distance from the query's true pose is its error. nullopt
/// if the query was not answered, or nothing was mapped that the answer could be compared with.
std::optional<SE3> answer_in_truth(const RunResult& run, QuerySet set, const QueryScore& query);

}  // namespace mh
