// SPDX-License-Identifier: Apache-2.0
#include "bench/run/verify.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "bench/report/results_json.hpp"
#include "slam/core/digest.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/temporary_folder.hpp"

namespace mh {
namespace {

constexpr int kFewJobs = 1, kManyJobs = 4;

/// The first stage at which two presentations of a frame differ; empty if none does.
template <class Presented>
std::string stage_of_difference(const Presented& a, const Presented& b) {
  if (a.index != b.index) return "order";
  if (a.image_digest != b.image_digest) return "image";
  if (a.matching_digest != b.matching_digest) return "matching";
  if (a.pose_digest != b.pose_digest) return "pose";
  return "";
}

std::size_t frame_of(const RunResult& run, Stamp stamp_ns) {
  for (const MappedFrame& call : run.mapping.calls)
    if (call.stamp_ns == stamp_ns) return call.index;
  return 0;
}

std::optional<Difference> difference_of_queries(const RunResult& a, const RunResult& b,
                                                std::size_t point, QuerySet set) {
  const std::vector<QueryScore>&x = queries(a.points[point], set),
        &y = queries(b.points[point], set);
  const std::string phase(name(set));
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    const std::string stage = stage_of_difference(x[i].answer, y[i].answer);
    if (!stage.empty()) return Difference{a.spec.name, phase, x[i].answer.index, 0, stage};
  }
  if (x.size() != y.size()) return Difference{a.spec.name, phase, 0, 0, "order"};
  return std::nullopt;
}

}  // namespace

std::string describe(const Difference& d) {
  std::string text = d.run.empty() ? "" : d.run + ": ";
  text += d.phase + ": ";
  if (d.phase == "world" || d.phase == "episodes") return text + d.stage + " differs";
  text += fmt::format("frame {}", d.frame);
  if (d.restart > 0) text += fmt::format(" (after {})", counted(d.restart, "restart"));
  return text + ": " + d.stage + " differs";
}

std::optional<Difference> first_difference(const RunResult& a, const RunResult& b) {
  if (a.place.scene_digest != b.place.scene_digest)
    return Difference{a.spec.name, "world", 0, 0, "scene"};
  if (a.place.path_digest != b.place.path_digest)
    return Difference{a.spec.name, "world", 0, 0, "path"};
  const std::vector<MappedFrame>&x = a.mapping.calls, &y = b.mapping.calls;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    const std::string stage = stage_of_difference(x[i], y[i]);
    if (!stage.empty()) return Difference{a.spec.name, "mapping", x[i].index, x[i].restart, stage};
  }
  if (x.size() != y.size())
    return Difference{a.spec.name, "mapping", std::min(x.size(), y.size()), 0, "order"};
  for (std::size_t i = 0; i < std::min(a.estimate.size(), b.estimate.size()); ++i)
    if (digest(Trajectory{a.estimate[i]}) != digest(Trajectory{b.estimate[i]}))
      return Difference{a.spec.name, "result", frame_of(a, a.estimate[i].stamp_ns), 0, "map"};
  for (std::size_t p = 0; p < std::min(a.points.size(), b.points.size()); ++p)
    for (const QuerySet set : kQuerySets)
      if (const auto difference = difference_of_queries(a, b, p, set)) return difference;
  if (a.episodes.size() != b.episodes.size())
    return Difference{a.spec.name, "episodes", 0, 0, "number"};
  for (std::size_t i = 0; i < a.episodes.size(); ++i)
    if (a.episodes[i].digest != b.episodes[i].digest)
      return Difference{a.spec.name, "episodes", 0, 0,
                        fmt::format("{}, start {}", a.episodes[i].variant, a.episodes[i].start)};
  if (a.map_digest != b.map_digest) return Difference{a.spec.name, "result", 0, 0, "map"};
  return std::nullopt;
}

std::optional<Difference> first_difference(std::span<const RunResult> a,
                                           std::span<const RunResult> b) {
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (const auto difference = first_difference(a[i], b[i])) return difference;
  return std::nullopt;
}

ExecutionDigests digests(const Suite& suite, std::span<const RunResult> runs) {
  ExecutionDigests d;
  const auto take = [&](const auto& shown) {
    d.images = chained(d.images, shown.image_digest);
    d.matching = chained(d.matching, shown.matching_digest);
    d.poses = chained(d.poses, shown.pose_digest);
  };
  for (const RunResult& run : runs) {
    d.scene = chained(d.scene, run.place.scene_digest);
    d.path = chained(d.path, run.place.path_digest);
    for (const MappedFrame& call : run.mapping.calls) take(call);
    for (const PointResult& point : run.points)
      for (const QuerySet set : kQuerySets)
        for (const QueryScore& q : queries(point, set)) take(q.answer);
    for (const EpisodeScore& episode : run.episodes) d.poses = chained(d.poses, episode.digest);
    d.maps = chained(d.maps, run.map_digest);
  }
  const std::string text = results_json(suite, runs).dump();
  d.results = digest_bytes(text.data(), text.size());
  return d;
}

Verification verify(const Suite& suite, const SuiteOverrides& overrides, BenchOptions options) {
  // Both executions read the same files and would give the same warnings.
  std::set<std::string> reported;
  options.say = [say = options.say, &reported](std::string_view what) {
    if (!what.starts_with("warning: ") || reported.emplace(what).second) say(what);
  };
  const auto report = std::exchange(options.progress, [](const PoolProgress&) {});
  const double shared_gb = options.images_limit_gb;
  const auto execute = [&](int jobs, double share_before) {
    options.say(fmt::format("executing with {}", counted(jobs, "job")));
    const TemporaryFolder folder(std::filesystem::temp_directory_path());
    options.out = folder.path();
    options.cache.reset();
    options.jobs = jobs;
    // In the first execution every run renders its own images; in the second, runs share them.
    options.images_limit_gb = share_before == 0 ? 0.0 : shared_gb;
    options.progress = [&](PoolProgress progress) {
      progress.share = share_before + 0.5 * progress.share;
      if (share_before == 0) progress.to_go_s.reset();  // the second half is still to come
      report(progress);
    };
    BenchResults results;
    try {
      results = run_suite(suite, overrides, options);
    } catch (Interrupted& interrupted) {
      interrupted.goes_on = false;
      throw;
    }
    if (!results.failed.empty())
      throw MachineError(
          fmt::format("{}: {}", results.failed.front().spec.name, results.failed.front().error));
    return std::move(results.runs);
  };
  const std::vector<RunResult> first = execute(kFewJobs, 0.0);
  const std::vector<RunResult> second = execute(kManyJobs, 0.5);

  Verification v;
  v.first = digests(suite, first);
  v.second = digests(suite, second);
  v.difference = first_difference(first, second);
  if (!v.difference && v.first != v.second) v.difference = Difference{"", "result", 0, 0, "scores"};
  return v;
}

}  // namespace mh
