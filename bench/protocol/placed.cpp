// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/placed.hpp"

namespace mh {

NearestBy nearest_by(QuerySet set) {
  return set == QuerySet::kHeldOut ? NearestBy::kTime : NearestBy::kPlace;
}

std::optional<SE3> answer_in_truth(const RunResult& run, QuerySet set, const QueryScore& query) {
  if (!query.answer.world_from_camera) return std::nullopt;
  const auto anchor =
      find_anchor(run.estimate, run.truth, {query.stamp_ns, query.true_world_from_camera},
                  nearest_by(set), run.spec.protocol);
  if (!anchor) return std::nullopt;
  return anchor->truth * anchor->estimate.inverse() * *query.answer.world_from_camera;
}

}  // namespace mh
