// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "bench/protocol/run_result.hpp"

namespace mh {

/// What is nearest to a query: for a held-out frame the next in time, for others the next in place.
NearestBy nearest_by(QuerySet set);

/// Where an answer lies in the frame of the truth: as far from the query's true pose as it was
/// scored, so relative to the nearest mapped frame (docs/protocol.md). nullopt if the query was not
/// answered, or nothing was mapped that the answer could be compared with.
std::optional<SE3> answer_in_truth(const RunResult& run, QuerySet set, const QueryScore& query);

}  // namespace mh
