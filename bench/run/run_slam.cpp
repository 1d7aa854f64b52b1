// SPDX-License-Identifier: Apache-2.0
#include "bench/run/run_slam.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "bench/protocol/usable_frame.hpp"
#include "slam/core/counted.hpp"
#include "slam/core/error.hpp"
#include "slam/core/trajectory_io.hpp"

namespace mh {
namespace {

/// One run in progress.
class Runner {
 public:
  Runner(SlamState& state, const Sequence& sequence, const SlamRunOptions& options,
         RandomStream stream, const StepObservers& observers)
      : state_(state),
        sequence_(sequence),
        options_(options),
        stream_(stream),
        observers_(observers) {}

  void offer(std::size_t index) {
    FrameOutcome outcome{.stamp_ns = sequence_.stamp_ns(index), .skipped = false, .report = {}};
    try {
      outcome.report = process(sequence_.frame(index, options_.noise), stream_.fork(index));
      count(outcome);
    } catch (const InputError& error) {
      outcome.skipped = true;
      ++run.skipped;
      if (run.faults.size() < SkippedFrames::kReasonsKept) run.faults.emplace_back(error.what());
    }
    run.frames.push_back(std::move(outcome));
    if (run.frames.size() == kHopeless && run.skipped == static_cast<int>(kHopeless))
      throw InputError(run.faults.front());
  }

  SlamRun run;

 private:
  StepReport process(const RgbdFrame& frame, RandomStream stream) {
    if (options_.localize) {
      require_increasing_stamp(frame.stamp_ns, localized_ns_);
      localized_ns_ = frame.stamp_ns;
      return localize(state_, localizer_, frame, stream, observers_);
    }
    StepReport report = step(state_, frame, stream, observers_);
    const bool found_before = run.tracked > 0 || options_.resume;
    if (report.status != TrackStatus::kLost || !found_before ||
        state_.map.keyframe_count() > options_.small_map)
      return report;
    SlamState anew = make_slam(state_.camera, state_.config, state_.vocabulary);
    StepReport first = step(anew, frame, stream, observers_);
    if (first.status != TrackStatus::kInitialized) return report;
    state_ = std::move(anew);
    forget_tracked();
    ++run.started_anew;
    return first;
  }

  /// A map that is given up takes its frames along.
  void forget_tracked() {
    for (FrameOutcome& frame : run.frames) {
      StepReport lost;
      lost.keypoints = frame.report.keypoints;
      frame.report = lost;
    }
    run.lost += run.tracked;
    run.tracked = run.relocalized = run.loops = 0;
  }

  void count(const FrameOutcome& outcome) {
    const StepReport& report = outcome.report;
    if (report.status == TrackStatus::kLost) {
      ++run.lost;
      return;
    }
    ++run.tracked;
    run.relocalized += report.status == TrackStatus::kRelocalized;
    run.loops += report.loop_closed;
    if (options_.localize) run.trajectory.push_back({outcome.stamp_ns, *report.world_from_camera});
  }

  SlamState& state_;
  const Sequence& sequence_;
  const SlamRunOptions& options_;
  RandomStream stream_;
  const StepObservers& observers_;
  Tracker localizer_;
  std::optional<Stamp> localized_ns_;  // the last frame that was offered to localize()
};

/// The state's poses at these moments.
Trajectory poses_at(const SlamState& state, const std::set<Stamp>& moments) {
  Trajectory all = trajectory(state), mine;
  std::copy_if(all.begin(), all.end(), std::back_inserter(mine),
               [&](const TimedPose& pose) { return moments.contains(pose.stamp_ns); });
  return mine;
}

}  // namespace

SlamRun run_slam(SlamState& state, const Sequence& sequence, const SlamRunOptions& options,
                 RandomStream stream, const StepObservers& observers, const SlamWatch& watch) {
  std::size_t first = std::min(options.first, sequence.size());
  if (options.resume && state.last_stamp_ns)
    while (first < sequence.size() && sequence.stamp_ns(first) <= *state.last_stamp_ns) ++first;
  const std::size_t last = first + std::min(options.count, sequence.size() - first);
  if (first == last) throw InputError("the sequence has no frame to offer");

  Runner runner(state, sequence, options, stream, observers);
  for (std::size_t i = first; i < last; ++i) {
    runner.offer(i);
    if (watch) watch(i + 1 - first, last - first, runner.run);
  }
  SlamRun run = std::move(runner.run);
  if (run.skipped == static_cast<int>(run.frames.size())) throw InputError(run.faults.front());
  if (state.map.empty())
    throw InputError(fmt::format(
        "nothing could be mapped: none of {} showed 100 keypoints with depth to begin with",
        counted(run.frames.size(), "frame")));
  if (!options.localize) {
    std::set<Stamp> fed;
    for (const FrameOutcome& frame : run.frames)
      if (!frame.skipped) fed.insert(frame.stamp_ns);
    if (options.resume)
      for (std::size_t i = 0; i < first; ++i) fed.insert(sequence.stamp_ns(i));
    run.trajectory = poses_at(state, fed);
  }
  return run;
}

std::string frames_csv(const SlamRun& run) {
  std::string text =
      "stamp_s,status,keypoints,inliers,keyframe,loop,relocalization,keyframes,c1,c2,c3,final\n";
  for (const FrameOutcome& f : run.frames) {
    const StepReport& r = f.report;
    fmt::format_to(std::back_inserter(text), "{},", format_stamp(f.stamp_ns));
    if (f.skipped) {
      text += "skipped,,,,,,,,,,\n";
      continue;
    }
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{}", name(r.status), r.keypoints,
                   r.inliers, r.keyframe_added ? 1 : 0, r.loop_closed ? 1 : 0,
                   name(r.relocalization));
    if (r.candidates)
      fmt::format_to(std::back_inserter(text), ",{},{},{},{},{}\n", r.candidates->keyframes,
                     r.candidates->c1, r.candidates->c2, r.candidates->c3, r.candidates->final);
    else
      text += ",,,,,\n";
  }
  return text;
}

}  // namespace mh
