// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/suite/run_spec.hpp"

namespace mh {

/// A run in progress.
struct RunAtWork {
  const RunSpec& spec;
  double age_s = 0;      ///< since its start
  double working_s = 0;  ///< since it first reported progress
  double share = 0;      ///< of its work done, in [0, 1]
};

/// Estimates the time remaining from the durations of finished runs: those of the same system in
/// the same environment; if there are none, those of the same system; otherwise all.
class Forecast {
 public:
  void note(const RunSpec& finished, double wall_s);
  /// Expected duration of a run; nullopt before any run has finished.
  std::optional<double> of(const RunSpec& run) const;
  /// Expected duration of all these runs, one after another; nullopt before any run has finished.
  std::optional<double> of_all(const std::vector<const RunSpec*>& runs) const;
  /// Time remaining; nullopt if no run has finished and some run in progress is less than 1/10
  /// done.
  /// @param waiting_s  of_all() for the runs that have not begun
  /// @param jobs       runs in parallel
  std::optional<double> to_go_s(double waiting_s, const std::vector<RunAtWork>& at_work,
                                int jobs) const;

 private:
  struct Mean {
    double sum_s = 0;
    int count = 0;
  };
  std::map<std::string, Mean> means_;
};

}  // namespace mh
