// SPDX-License-Identifier: Apache-2.0
#include "bench/report/recordings_text.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "slam/io/counted.hpp"

namespace mh {
namespace {

/// The first run of each system with each kind of labels on one recording: all trials see the same
/// images.
using Runs = std::vector<const RunResult*>;

Runs first_runs(std::span<const RunResult> runs, const Environment& environment) {
  Runs first;
  for (const RunResult& run : runs)
    if (run.spec.environment.name == environment.name &&
        std::ranges::none_of(first, [&](const RunResult* known) {
          return known->spec.system.name == run.spec.system.name &&
                 known->spec.labels == run.spec.labels;
        }))
      first.push_back(&run);
  return first;
}

std::string skipped_text(const Runs& runs) {
  const auto skipped = [](const RunResult* run) { return run->mapping.skipped; };
  const bool alike = std::ranges::all_of(
      runs, [&](const RunResult* run) { return skipped(run) == skipped(runs.front()); });
  std::string text;
  for (const RunResult* run : alike ? Runs{runs.front()} : runs)
    if (const SkippedFrames frames = skipped(run); frames.count > 0)
      text += fmt::format(
          "  {}{}: {} skipped, the first: {}\n", run->spec.environment.name,
          alike ? ""
                : fmt::format(", {} ({})", run->spec.system.name, with_labels(run->spec.labels)),
          counted(frames.count, "frame"), frames.reasons.front());
  return text;
}

std::string truth_text(const RunResult& run) {
  std::string text;
  const auto add = [&](const PathFacts& path, const char* what) {
    if (path.true_poses > 0 && path.true_poses < path.frames)
      text += fmt::format("  {}{}: {} of {} have a true pose; the others are not scored\n",
                          run.spec.environment.name, what, path.true_poses,
                          counted(path.frames, "frame"));
  };
  add(run.place.mapping, "");
  if (run.place.query_tour) add(*run.place.query_tour, ", queries");
  return text;
}

std::string notes_text(const RunResult& run) {
  std::string text;
  for (const std::string& note : run.place.notes)
    text += fmt::format("  {}: {}\n", run.spec.environment.name, note);
  return text;
}

/// Warns about a second recording if its queries were answered several times (by all systems
/// together) but never correctly.
std::string other_frame_text(const Runs& runs) {
  constexpr std::size_t kFewest = 3;
  std::vector<double> distances_m;
  for (const RunResult* run : runs)
    for (const PointResult& point : run->points)
      for (const QueryScore& query : point.second_tour) {
        if (query.correct) return "";
        if (query.false_positive && query.distance_m) distances_m.push_back(*query.distance_m);
      }
  if (distances_m.size() < kFewest) return "";
  const auto [nearest, farthest] = std::ranges::minmax(distances_m);
  return fmt::format(
      "  warning: {}: all {} to `queries` are wrong, by {:.2f} to {:.2f} m: are its true poses in "
      "the frame of reference of `sequence`?\n",
      runs.front()->spec.environment.name, counted(distances_m.size(), "answer"), nearest,
      farthest);
}

}  // namespace

std::string recordings_text(const Suite& suite, std::span<const RunResult> runs) {
  if (std::ranges::none_of(suite.environments, &Environment::is_recorded)) return "";
  std::string text = "\nrecordings have only one noise: trials differ only in RANSAC's draws\n";
  for (const Environment& environment : suite.environments)
    if (const Runs of_it = first_runs(runs, environment);
        environment.is_recorded() && !of_it.empty())
      text += notes_text(*of_it.front()) + skipped_text(of_it) + truth_text(*of_it.front()) +
              other_frame_text(of_it);
  return text;
}

}  // namespace mh
