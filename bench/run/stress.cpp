// SPDX-License-Identifier: Apache-2.0
#include "bench/run/stress.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "bench/protocol/metrics/alignment.hpp"
#include "bench/protocol/metrics/averages.hpp"
#include "bench/protocol/metrics/trajectory_score.hpp"
#include "bench/suite/stress_spec.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

void require_stressable(const Suite& suite) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{}: {}", suite.file.string(), why));
  };
  if (!suite.stress) refuse("has no section `stress` with the dials to turn");
  if (suite.levels.size() != 1) refuse("levels: a stress test turns the dials of one");
  if (suite.labels.size() != 1) refuse("labels: a stress test uses one kind");
  if (!suite.sweep.points.empty())
    refuse("parameters: the dials of `stress` are turned, not these");
  if (suite.episodes || suite.graded) refuse("a stress test has neither `episodes` nor `graded`");
}

/// The number of frames whose pose is near the truth, after alignment of the whole path.
double placed_right(const RunResult& run, double near_m) {
  const MatchedTrajectories matched = match_by_stamp(run.truth, run.estimate);
  const SE3 truth_from_estimate = align_estimate(run.estimate, run.truth).truth_from_estimate;
  double right = 0;
  for (std::size_t i = 0; i < matched.size(); ++i) {
    const SE3 placed = truth_from_estimate * matched.estimate[i].world_from_camera;
    const double error_m =
        (placed.translation() - matched.truth[i].world_from_camera.translation()).norm();
    if (error_m <= near_m) ++right;
  }
  return right;
}

/// One system's share of right answers in each room at a dose.
StressedAt stressed_at(const Suite& suite, const std::string& system, const BenchResults& results,
                       double dose, double share) {
  StressedAt at;
  at.dose = dose;
  at.result.at = share;
  for (const FailedRun& failed : results.failed)
    if (failed.spec.system.name == system) {
      at.error = fmt::format("{}: {}", failed.spec.name, failed.error);
      return at;
    }
  double offered = 0, tracked = 0;
  std::vector<double> errors_m;
  for (const Environment& environment : suite.environments) {
    double right = 0, asked = 0;
    for (const RunResult& run : results.runs) {
      if (run.spec.environment.name != environment.name || run.spec.system.name != system) continue;
      offered += run.trajectory.offered;
      tracked += run.trajectory.tracked;
      if (run.trajectory.ate_rmse_m) errors_m.push_back(*run.trajectory.ate_rmse_m);
      if (suite.stress->measure == StressMeasure::kPlaced) {
        right += placed_right(run, suite.stress->near_m);
        asked += run.trajectory.offered;
      } else {
        for (const QueryScore& query : run.points.front().held_out) {
          if (!is_judged(query)) continue;
          right += query.correct ? 1 : 0;
          asked += 1;
        }
      }
    }
    at.result.right.push_back(right);
    at.result.asked.push_back(asked);
  }
  if (std::accumulate(at.result.asked.begin(), at.result.asked.end(), 0.0) == 0 && share == 0)
    at.error = "nothing is asked: no frame is held out, or it answers no queries; use `placed`";
  at.completeness = offered > 0 ? tracked / offered : 0;
  if (!errors_m.empty()) at.ate_rmse_m = median(std::move(errors_m));
  return at;
}

/// A bisection in progress.
struct Search {
  StressCurve curve;
  double bar = 0;                 ///< share below which the system is broken
  double stands = 0, breaks = 1;  ///< shares of the dial's range
  int steps = 0;
  bool done = false;

  void add(StressedAt at) {
    if (!at.error.empty()) {
      curve.error = at.error;
      done = true;
      return;
    }
    const auto place = std::ranges::upper_bound(curve.doses, at.result.at, {},
                                                [](const StressedAt& d) { return d.result.at; });
    curve.doses.insert(place, std::move(at));
  }
};

}  // namespace

StressResults find_breaking_points(const Suite& suite, const RunAtDose& run,
                                   const StressOptions& options) {
  const StressSpec& spec = *suite.stress;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const auto is_late = [&] {
    return options.budget_s > 0 &&
           std::chrono::duration<double>(Clock::now() - start).count() > options.budget_s;
  };
  StressResults results;
  std::vector<StressedAt> clean;  // without any fault, by system: the same for every dial
  for (std::size_t d = 0; d < spec.dials.size() && !is_late(); ++d) {
    const StressDial& dial = spec.dials[d];
    std::vector<Search> searches(suite.systems.size());
    const auto run_at = [&](const std::vector<std::size_t>& systems, double dose) {
      options.step(static_cast<double>(d) / static_cast<double>(spec.dials.size()),
                   fmt::format("{} {:.4g} {}", dial.name, shown_dose(dial, dose), dial.unit));
      const std::vector<StressedAt> made = run(systems, dial, dose, true);
      for (std::size_t k = 0; k < systems.size(); ++k) searches[systems[k]].add(made[k]);
    };
    std::vector<std::size_t> standing(suite.systems.size());
    std::iota(standing.begin(), standing.end(), std::size_t{0});
    if (clean.empty()) {
      options.step(0, "without a fault");
      clean = run(standing, dial, dial.from, false);
    }
    for (const std::size_t s : standing) {
      StressedAt at = clean[s];
      at.dose = dial.from;
      searches[s].add(std::move(at));
    }
    std::erase_if(standing, [&](std::size_t s) {
      Search& search = searches[s];
      if (!search.done) search.bar = spec.bar * search.curve.doses.front().result.share();
      return search.done || search.bar <= 0;
    });
    if (!standing.empty()) run_at(standing, dial.to);
    std::erase_if(standing, [&](std::size_t s) {
      return searches[s].done || searches[s].curve.doses.back().result.share() >= searches[s].bar;
    });
    while (!standing.empty()) {
      // Systems whose next dose is the same are shown the same images.
      std::map<double, std::vector<std::size_t>> next;
      std::erase_if(standing, [&](std::size_t s) {
        const Search& search = searches[s];
        const double dose = dose_at(dial, 0.5 * (search.stands + search.breaks));
        const double share = share_of(dial, dose);
        // A whole dial may have no dose between.
        if (search.done || search.steps == spec.steps || share <= search.stands ||
            share >= search.breaks)
          return true;
        next[dose].push_back(s);
        return false;
      });
      for (const auto& [dose, systems] : next) {
        run_at(systems, dose);
        for (const std::size_t s : systems) {
          Search& search = searches[s];
          if (search.done) continue;
          const double share = share_of(dial, dose);
          const auto at = std::ranges::find(search.curve.doses, dose, &StressedAt::dose);
          (at->result.share() >= search.bar ? search.stands : search.breaks) = share;
          ++search.steps;
        }
      }
    }
    for (std::size_t s = 0; s < searches.size(); ++s) {
      StressCurve& curve = searches[s].curve;
      curve.dial = d;
      curve.system = s;
      if (curve.error.empty()) curve.point = breaking_point(doses_of(curve), spec.bar, suite.seed);
      results.curves.push_back(std::move(curve));
    }
    results.dials_reached = d + 1;
  }
  return results;
}

StressResults stress(const Suite& suite, const SuiteOverrides& overrides,
                     const StressOptions& options) {
  require_stressable(suite);
  InputReader inputs(options.bench.say);
  BenchOptions bench = options.bench;
  bench.metrics_only = true;
  bench.inputs = &inputs;
  bench.say = [](std::string_view) {};
  return find_breaking_points(
      suite,
      [&](const std::vector<std::size_t>& systems, const StressDial& dial, double dose,
          bool is_fault) {
        Suite some = suite;
        some.systems.clear();
        for (const std::size_t s : systems) some.systems.push_back(suite.systems[s]);
        some.compare.clear();
        if (is_fault) some.levels.front().doses.push_back({dial.dial, dose});
        const BenchResults results = run_suite(some, overrides, bench);
        std::vector<StressedAt> made;
        for (const std::size_t s : systems)
          made.push_back(stressed_at(suite, suite.systems[s].name, results, dose,
                                     is_fault ? share_of(dial, dose) : 0));
        return made;
      },
      options);
}

}  // namespace mh
