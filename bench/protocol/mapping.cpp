// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/mapping.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "bench/protocol/streams.hpp"
#include "bench/protocol/system_report.hpp"
#include "slam/core/digest.hpp"
#include "slam/core/imu.hpp"

namespace mh {
namespace {

/// State of the feed. Indices are frames of the sequence.
struct Feed {
  std::size_t next = 0;
  bool in_trouble = false;
  std::size_t to_pass = 0;  ///< after a failure: the furthest frame that failed
  int restarts_here = 0;    ///< consecutive restarts that did not get past to_pass
  int dropped_in_row = 0;
  bool tracking = false;
  bool mapped = false;  ///< something was tracked since the start or the last reset
};

/// The IMU readings since the previously shown frame or, after a jump back, since the preceding
/// frame of the sequence.
std::vector<ImuReading> imu_since(const Sequence& sequence, std::optional<Stamp> shown_ns,
                                  std::size_t index) {
  const Stamp since_ns = shown_ns    ? *shown_ns
                         : index > 0 ? sequence.stamp_ns(index - 1)
                                     : std::numeric_limits<Stamp>::min();
  const auto readings = imu_between(sequence.imu(), since_ns, sequence.stamp_ns(index));
  return {readings.begin(), readings.end()};
}

bool is_failure(const Feed& feed, std::size_t index) {
  return feed.mapped && (feed.tracking || !feed.in_trouble || index >= feed.to_pass);
}

void go_back(Feed& feed, std::size_t failed, const ProtocolConfig& config) {
  feed.to_pass = feed.in_trouble ? std::max(failed, feed.to_pass) : failed;
  feed.in_trouble = true;
  feed.next =
      failed - std::min<std::size_t>(failed, static_cast<std::size_t>(config.rewind_frames));
  feed.tracking = false;
}

void note_tracked(Feed& feed, std::size_t index) {
  feed.tracking = feed.mapped = true;
  if (feed.in_trouble && index >= feed.to_pass) {
    feed.in_trouble = false;
    feed.restarts_here = 0;
    feed.dropped_in_row = 0;
  }
}

bool is_hopeless(const Feed& feed, const ProtocolConfig& config) {
  return config.hopeless_after > 0 && feed.dropped_in_row >= config.hopeless_after;
}

/// Records the report on a frame that was shown.
void note(MappingOutcome& outcome, std::size_t index, const RgbdFrame& frame,
          const SystemReport& report, const MappingObserver& observe) {
  outcome.calls.push_back({.index = index,
                           .stamp_ns = frame.stamp_ns,
                           .restart = outcome.restarts,
                           .status = report.status,
                           .inliers = report.inliers,
                           .keyframe_added = report.keyframe_added,
                           .map_reset = report.map_reset,
                           .image_digest = digest(frame),
                           .matching_digest = digest_of_matching(report),
                           .pose_digest = digest(report.world_from_camera)});
  add(report.matches, outcome.matches);
  if (report.loop) outcome.loops.push_back(*report.loop);
  if (observe) observe(outcome.calls.back(), frame, report);
}

}  // namespace

bool is_test_frame(std::size_t index, const ProtocolConfig& config) {
  return config.test_interval > 0 &&
         (index + 1) % static_cast<std::size_t>(config.test_interval) == 0;
}

std::vector<std::size_t> offered_frames(std::size_t count, const ProtocolConfig& config,
                                        std::size_t first) {
  std::vector<std::size_t> indices;
  for (std::size_t i = first; i < count; ++i)
    if (!is_test_frame(i, config)) indices.push_back(i);
  return indices;
}

MappingOutcome map_sequence(System& system, const Sequence& sequence, const ProtocolConfig& config,
                            RandomStream stream, const MappingObserver& observe,
                            std::size_t first) {
  const std::size_t count = sequence.size();
  MappingOutcome outcome;
  outcome.offered = offered_frames(count, config, first).size();
  UsableFrames frames(sequence);
  std::vector<bool> out(count, false);  // dropped or skipped
  const std::size_t max_calls = std::max(
      count + 1000, static_cast<std::size_t>(config.max_effort * static_cast<double>(count)));

  Feed feed{.next = first, .mapped = first > 0};
  std::optional<Stamp> shown_ns;  // of the last frame shown; absent after a jump back
  while (feed.next < count) {
    const std::size_t i = feed.next++;
    if (is_test_frame(i, config) || out[i]) continue;
    if (outcome.calls.size() >= max_calls) {
      outcome.gave_up = true;
      break;
    }
    auto frame = frames.frame(i, mapping_noise(stream, outcome.restarts));
    if (!frame) {
      out[i] = true;
      continue;
    }
    frame->imu = imu_since(sequence, shown_ns, i);
    shown_ns = frame->stamp_ns;
    const RandomStream draws =
        stream.fork(RunDraw::kSlam).fork(static_cast<std::uint64_t>(outcome.restarts)).fork(i);
    const SystemReport report = system.track(*frame, draws);
    note(outcome, i, *frame, report, observe);

    if (report.status != TrackStatus::kLost) {
      note_tracked(feed, i);
      continue;
    }
    if (!feed.mapped) ++outcome.before_map;
    if (config.on_failure == OnFailure::kContinue) {
      outcome.failures += feed.tracking ? 1 : 0;
      feed.tracking = false;
      continue;
    }
    if (!is_failure(feed, i)) continue;

    ++outcome.failures;
    if (is_hopeless(feed, config)) {
      feed.to_pass = i;
      feed.tracking = false;
    } else {
      go_back(feed, i, config);
      shown_ns.reset();
      system.rewind();
      ++outcome.restarts;
      if (feed.restarts_here < config.restarts_per_frame) {
        ++feed.restarts_here;
        continue;
      }
    }
    out[i] = true;
    outcome.dropped.push_back(i);
    feed.restarts_here = 0;
    ++feed.dropped_in_row;
    if (config.reset == DropReset::kMap) {
      system.reset();
      feed.mapped = false;
    }
  }
  frames.require_any();
  outcome.skipped = frames.skipped();
  return outcome;
}

Localization localize_sequence(const System& frozen, const Sequence& sequence,
                               const ProtocolConfig& config, RandomStream stream,
                               const MappingObserver& observe) {
  Localization found;
  const std::vector<std::size_t> offered = offered_frames(sequence.size(), config);
  found.outcome.offered = offered.size();
  UsableFrames frames(sequence);
  const auto session = frozen.open_session();
  for (const std::size_t i : offered) {
    const auto frame = frames.frame(i, mapping_noise(stream, 0));
    if (!frame) continue;
    const SystemReport report = session->feed(*frame, stream.fork(RunDraw::kSlam).fork(0).fork(i));
    note(found.outcome, i, *frame, report, observe);
    if (report.status != TrackStatus::kLost)
      found.trajectory.push_back({frame->stamp_ns, *report.world_from_camera});
  }
  frames.require_any();
  found.outcome.skipped = frames.skipped();
  return found;
}

}  // namespace mh
