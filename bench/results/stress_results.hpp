// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bench/results/breaking_point.hpp"

namespace mh {

/// What one system did at one dose of one dial, over all rooms.
struct StressedAt {
  double dose = 0;
  DoseResult result;
  double completeness = 0;           ///< share of the frames with a pose, all rooms together
  std::optional<double> ate_rmse_m;  ///< median over the rooms that have one
  std::string error = {};            ///< why there is no result: a run failed
};

/// How one system stands one dial.
struct StressCurve {
  std::size_t dial = 0, system = 0;  ///< in the suite's stress.dials and systems
  std::vector<StressedAt> doses;     ///< ascending from no fault
  BreakingPoint point;
  std::string error = {};  ///< why there is no point: the system's runs failed at some dose
};

struct StressResults {
  std::vector<StressCurve> curves;  ///< by dial, then system
  std::size_t dials_reached = 0;    ///< the first of the suite's dials; the others were not tried
};

/// The doses of a curve as breaking_point() takes them.
inline std::vector<DoseResult> doses_of(const StressCurve& curve) {
  std::vector<DoseResult> doses;
  for (const StressedAt& at : curve.doses) doses.push_back(at.result);
  return doses;
}

}  // namespace mh
