// SPDX-License-Identifier: Apache-2.0
#include "bench/verify/verify.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "bench/protocol/digest.hpp"
#include "bench/results/json.hpp"

namespace mh {
namespace {

constexpr int kFewJobs = 1, kManyJobs = 4;

std::uint64_t chain(std::uint64_t sum, std::uint64_t next) {
  return digest_bytes(&next, sizeof next, sum);
}

std::uint64_t digest_paths(const World& world) {
  const std::uint64_t mapping = digest(world.mapping.camera);
  return world.second ? chain(mapping, digest(world.second->camera)) : mapping;
}

std::uint64_t digest_map(const RunResult& run) {
  const std::uint64_t grid =
      digest_bytes(run.grid.cells.data(), run.grid.cells.size(), digest(run.estimate));
  return chain(grid, run.volume ? run.volume->leaf_count() : 0);
}

/// The stage at which one showing of a frame differs; empty if none does.
template <class Shown>
std::string stage_of_difference(const Shown& a, const Shown& b) {
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
                                                QuerySet set) {
  const std::vector<QueryScore>&x = queries(a, set), &y = queries(b, set);
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
  if (d.phase == "world") return text + d.stage + " differs";
  text += fmt::format("frame {}", d.frame);
  if (d.restart > 0) text += fmt::format(" (after {} restarts)", d.restart);
  return text + ": " + d.stage + " differs";
}

std::optional<Difference> first_difference(const World& a, const World& b) {
  if (digest(*a.scene) != digest(*b.scene)) return Difference{"", "world", 0, 0, "scene"};
  if (digest_paths(a) != digest_paths(b)) return Difference{"", "world", 0, 0, "path"};
  return std::nullopt;
}

std::optional<Difference> first_difference(const RunResult& a, const RunResult& b) {
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
  for (const QuerySet set : {QuerySet::kHeldOut, QuerySet::kSecondTour})
    if (const auto difference = difference_of_queries(a, b, set)) return difference;
  if (digest_map(a) != digest_map(b)) return Difference{a.spec.name, "result", 0, 0, "map"};
  return std::nullopt;
}

std::optional<Difference> first_difference(const std::vector<RunResult>& a,
                                           const std::vector<RunResult>& b) {
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (const auto difference = first_difference(a[i], b[i])) return difference;
  return std::nullopt;
}

ExecutionDigests digests(const Suite& suite, const World& world,
                         const std::vector<RunResult>& runs) {
  ExecutionDigests d{.scene = digest(*world.scene), .path = digest_paths(world)};
  const auto take = [&](const auto& shown) {
    d.images = chain(d.images, shown.image_digest);
    d.matching = chain(d.matching, shown.matching_digest);
    d.poses = chain(d.poses, shown.pose_digest);
  };
  for (const RunResult& run : runs) {
    for (const MappedFrame& call : run.mapping.calls) take(call);
    for (const QueryScore& q : run.held_out) take(q.answer);
    for (const QueryScore& q : run.second_tour) take(q.answer);
    d.maps = chain(d.maps, digest_map(run));
  }
  const std::string text = results_json(suite, world, runs).dump();
  d.results = digest_bytes(text.data(), text.size());
  return d;
}

Verification verify(const Suite& suite, RunOptions options, const SystemFactory& factory) {
  const RunTamper tamper = std::exchange(options.tamper, {});
  const auto tell = std::exchange(options.progress, {});
  const auto execute = [&](int jobs, double share_before) {
    options.say(fmt::format("executing with {} job{}", jobs, jobs == 1 ? "" : "s"));
    options.jobs = jobs;
    options.progress = [&tell, share_before](double share) {
      if (tell) tell(share_before + 0.5 * share);
    };
    World world = build_world(suite, options.max_frames, jobs, options.say);
    std::vector<RunResult> runs = run_all(suite, world, options, factory);
    return std::pair(std::move(world), std::move(runs));
  };
  const auto [first_world, first_runs] = execute(kFewJobs, 0.0);
  options.tamper = tamper;
  const auto [second_world, second_runs] = execute(kManyJobs, 0.5);

  Verification v;
  v.first = digests(suite, first_world, first_runs);
  v.second = digests(suite, second_world, second_runs);
  v.difference = first_difference(first_world, second_world);
  if (!v.difference) v.difference = first_difference(first_runs, second_runs);
  if (!v.difference && v.first != v.second) v.difference = Difference{"", "result", 0, 0, "scores"};
  return v;
}

}  // namespace mh
