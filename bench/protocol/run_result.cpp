// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/run_result.hpp"

namespace mh {

void set_estimate(RunResult& run, const Trajectory& all) {
  const std::uint32_t largest = largest_map(all);
  run.estimate = of_map(all, largest);
  run.elsewhere.clear();
  for (const TimedPose& pose : all)
    if (pose.map != largest) run.elsewhere.push_back(pose);
}

void take_trajectory(RunResult& run, const Trajectory& all) {
  set_estimate(run, all);
  run.trajectory = score_trajectory(run.estimate, run.truth, run.mapping.offered);
  if (run.mapping.offered > 0)
    run.trajectory.in_any_map =
        static_cast<double>(all.size()) / static_cast<double>(run.mapping.offered);
  run.alignment = align_estimate(run.estimate, run.truth);
}

namespace {

bool is_in_largest_map(const RunResult& run, const QueryAnswer& answer) {
  return run.estimate.empty() || run.estimate.front().map == answer.map;
}

}  // namespace

Trajectory mapped_beside(const RunResult& run, const QueryAnswer& answer) {
  return is_in_largest_map(run, answer) ? run.estimate : of_map(run.elsewhere, answer.map);
}

QueryScore score(const RunResult& run, const QueryAnswer& answer, const QueryMoment& moment,
                 const std::optional<Anchor>& anchor) {
  std::optional<SE3> truth_from_estimate;
  if (is_in_largest_map(run, answer)) truth_from_estimate = run.alignment.truth_from_estimate;
  return score(answer, moment, anchor, truth_from_estimate, run.spec.protocol);
}

}  // namespace mh
