// SPDX-License-Identifier: Apache-2.0
#include "bench/run/forecast.hpp"

#include <algorithm>
#include <array>

namespace mh {
namespace {

/// Keys of the groups of runs that are similar to this one, most similar first.
std::array<std::string, 3> kinds_of(const RunSpec& run) {
  return {run.system.name + '\n' + run.environment.name, run.system.name, ""};
}

}  // namespace

void Forecast::note(const RunSpec& finished, double wall_s) {
  for (const std::string& kind : kinds_of(finished)) {
    means_[kind].sum_s += wall_s;
    ++means_[kind].count;
  }
}

std::optional<double> Forecast::of(const RunSpec& run) const {
  for (const std::string& kind : kinds_of(run))
    if (const auto mean = means_.find(kind); mean != means_.end())
      return mean->second.sum_s / mean->second.count;
  return std::nullopt;
}

std::optional<double> Forecast::of_all(const std::vector<const RunSpec*>& runs) const {
  double sum_s = 0;
  for (const RunSpec* run : runs) {
    const auto wall_s = of(*run);
    if (!wall_s) return std::nullopt;
    sum_s += *wall_s;
  }
  return sum_s;
}

std::optional<double> Forecast::to_go_s(double waiting_s, const std::vector<RunAtWork>& at_work,
                                        int jobs) const {
  constexpr double kEnough = 0.1;  // share of a run's work after which its rest is extrapolated
  double all_s = waiting_s, longest_s = 0;
  for (const RunAtWork& run : at_work) {
    std::optional<double> left_s;
    if (run.share >= kEnough)
      left_s = run.working_s * (1 - run.share) / run.share;
    else if (const auto wall_s = of(run.spec))
      left_s = std::max(0.0, *wall_s - run.age_s);
    if (!left_s) return std::nullopt;
    all_s += *left_s;
    longest_s = std::max(longest_s, *left_s);
  }
  return std::max(longest_s, all_s / std::max(1, jobs));
}

}  // namespace mh
