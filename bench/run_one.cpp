// SPDX-License-Identifier: Apache-2.0
#include "bench/run_one.hpp"

#include <algorithm>
#include <chrono>

#include "bench/results/occupancy.hpp"
#include "bench/results/trajectory_score.hpp"
#include "bench/systems/tampered.hpp"

namespace mh {
namespace {

enum StreamName : std::uint64_t { kMapping = 1, kHeldOut = 2, kSecondTour = 3 };

/// Frames of one path as one run sees them.
FrameSource source(FrameStudio& studio, const RunSpec& spec, const RunTamper& tamper,
                   FrameStudio::Following following = {}) {
  return [&studio, &spec, &tamper, following](std::size_t index, RandomStream noise) {
    RgbdFrame frame = studio.frame(index, noise, spec.labels, following);
    if (tamper.frame) tamper.frame(spec, index, frame);
    return frame;
  };
}

std::vector<QueryScore> put_queries(const System& frozen, FrameStudio& studio, NearestBy by,
                                    const RunResult& run, const Trajectory& mapping_truth,
                                    const FrameSource& frames, const ProtocolConfig& protocol,
                                    RandomStream stream,
                                    const std::function<void(std::size_t)>& advance) {
  std::vector<QueryScore> scores;
  for (const std::size_t index : test_frames(studio.size(), protocol)) {
    advance(scores.size());
    const QueryAnswer answer = query(frozen, index, frames, protocol, stream);
    const TimedPose& truth = studio.path()[index];
    scores.push_back(score(answer, truth, nearest_mapped(run.estimate, mapping_truth, truth, by),
                           run.trajectory.truth_from_estimate, protocol));
  }
  return scores;
}

}  // namespace

RunResult run_one(const RunSpec& spec, const Suite& suite, std::unique_ptr<System> inner,
                  const RunPlace& place, const std::function<void(std::size_t)>& advance,
                  const RunTamper& tamper) {
  const auto start = std::chrono::steady_clock::now();
  const RandomStream stream(suite.seed + static_cast<std::uint64_t>(spec.trial));
  const Trajectory& truth = place.mapping.path();
  if (tamper.report)
    inner = make_tampered(std::move(inner),
                          [&](std::size_t call, StepReport& r) { tamper.report(spec, call, r); });
  TimedSystem system(std::move(inner));
  RunResult run;
  run.spec = spec;

  const FrameSource frames = source(place.mapping, spec, tamper);
  const FrameSource mapped_frames = source(place.mapping, spec, tamper, [&](std::size_t index) {
    do ++index;
    while (is_test_frame(index, suite.protocol));
    return index;
  });
  KeyframeDepths depths;
  run.mapping = map_sequence(
      system, place.mapping.size(),
      [&](std::size_t index, RandomStream noise) {
        advance(index);
        return mapped_frames(index, noise);
      },
      suite.protocol, stream.fork(kMapping),
      [&](const MappedFrame& call, const RgbdFrame& frame, const StepReport&) {
        if (call.keyframe_added) depths.keep(frame);
      });
  system.freeze();

  run.estimate = system.trajectory();
  run.trajectory = score_trajectory(run.estimate, truth, run.mapping.offered);

  std::size_t done = place.mapping.size();
  run.held_out =
      put_queries(system, place.mapping, NearestBy::kTime, run, truth, frames, suite.protocol,
                  stream.fork(kHeldOut), [&](std::size_t i) { advance(done + i); });
  done += run.held_out.size();
  if (place.second_tour != nullptr)
    run.second_tour =
        put_queries(system, *place.second_tour, NearestBy::kPlace, run, truth,
                    source(*place.second_tour, spec, tamper), suite.protocol,
                    stream.fork(kSecondTour), [&](std::size_t i) { advance(done + i); });

  const Robot& robot = place.robot;
  run.volume = depths.integrate(robot.camera, run.estimate, run.trajectory.dock_from_estimate);
  // From just over the floor (noise of the depth at 4 m lies below) to the top of the head.
  run.grid = run.volume->project(0.10, robot.height_m);
  run.times = system.times();
  run.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

}  // namespace mh
