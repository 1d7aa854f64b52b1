// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/plan/runs.hpp"

namespace mh {

/// A run that is being worked off.
struct RunAtWork {
  RunSpec spec;
  double age_s = 0;      ///< since its start
  double working_s = 0;  ///< since it told of work done for the first time
  double share = 0;      ///< of its work done, in [0, 1]
};

/// Tells the time to go from what finished runs took: those of the same system in the same
/// environment, else of the same system, else of any.
class Forecast {
 public:
  void note(const RunSpec& finished, double wall_s);
  /// Of a run like that from start to end; nullopt before anything has finished.
  std::optional<double> of(const RunSpec& run) const;
  /// Nullopt where it cannot be told: runs wait and none has finished, or the runs at work have
  /// done less than a tenth of theirs.
  /// @param jobs  runs side by side
  std::optional<double> to_go_s(const std::vector<RunSpec>& waiting,
                                const std::vector<RunAtWork>& at_work, int jobs) const;

 private:
  struct Mean {
    double sum_s = 0;
    int count = 0;
  };
  std::map<std::string, Mean> means_;
};

}  // namespace mh
