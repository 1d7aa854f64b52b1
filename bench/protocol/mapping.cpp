// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/mapping.hpp"

#include <algorithm>

#include "bench/protocol/step_digest.hpp"
#include "bench/provenance/digest.hpp"

namespace mh {
namespace {

enum StreamName : std::uint64_t { kNoise = 1, kSlam = 2 };

/// Where the feed stands. Indices count frames of the sequence.
struct Feed {
  std::size_t next = 0;
  bool in_trouble = false;
  std::size_t to_pass = 0;  ///< while in trouble: the furthest frame that failed
  int restarts_here = 0;    ///< in a row, without getting past to_pass
  bool tracking = false;
  bool mapped = false;  ///< something was tracked since the start or the last reset
};

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
  }
}

}  // namespace

bool is_test_frame(std::size_t index, const ProtocolConfig& config) {
  return (index + 1) % static_cast<std::size_t>(config.test_interval) == 0;
}

RandomStream mapping_noise(RandomStream stream, int restart) {
  return stream.fork(kNoise).fork(static_cast<std::uint64_t>(restart));
}

MappingOutcome map_sequence(System& system, const Sequence& sequence, const ProtocolConfig& config,
                            RandomStream stream, const MappingObserver& observe) {
  const std::size_t count = sequence.size();
  MappingOutcome outcome;
  for (std::size_t i = 0; i < count; ++i) outcome.offered += is_test_frame(i, config) ? 0 : 1;
  const std::vector<bool> has_stamp = increasing_stamps(sequence);
  std::vector<bool> out(count, false);  // dropped or skipped
  const auto skip = [&](std::size_t i, const std::string& reason) {
    out[i] = true;
    outcome.skipped.add(reason);
    if (outcome.calls.empty() && outcome.skipped.count == kHopeless)
      throw InputError(outcome.skipped.reasons.front());
  };
  const std::size_t max_calls = std::max(
      count + 1000, static_cast<std::size_t>(config.max_effort * static_cast<double>(count)));

  Feed feed;
  while (feed.next < count) {
    const std::size_t i = feed.next++;
    if (is_test_frame(i, config) || out[i]) continue;
    if (outcome.calls.size() >= max_calls) {
      outcome.gave_up = true;
      break;
    }
    if (!has_stamp[i]) {
      skip(i, stamp_fault(sequence, i));
      continue;
    }
    RgbdFrame frame;
    try {
      frame = usable_frame(sequence, i, mapping_noise(stream, outcome.restarts));
    } catch (const UnusableFrame& error) {
      skip(i, error.what());
      continue;
    }
    const RandomStream draws =
        stream.fork(kSlam).fork(static_cast<std::uint64_t>(outcome.restarts)).fork(i);
    const SystemReport report = system.track(frame, draws);
    outcome.calls.push_back({.index = i,
                             .stamp_ns = frame.stamp_ns,
                             .restart = outcome.restarts,
                             .status = report.status,
                             .inliers = report.inliers,
                             .keyframe_added = report.keyframe_added,
                             .image_digest = digest(frame),
                             .matching_digest = digest_of_matching(report),
                             .pose_digest = digest(report.world_from_camera)});
    add(report.matches, outcome.matches);
    if (report.loop) outcome.loops.push_back(*report.loop);
    if (observe) observe(outcome.calls.back(), frame, report);

    if (report.status != TrackStatus::kLost) {
      note_tracked(feed, i);
      continue;
    }
    if (!feed.mapped) ++outcome.before_map;
    if (!is_failure(feed, i)) continue;

    ++outcome.failures;
    go_back(feed, i, config);
    system.rewind();
    ++outcome.restarts;
    if (feed.restarts_here < config.restarts_per_frame) {
      ++feed.restarts_here;
      continue;
    }
    out[i] = true;
    outcome.dropped.push_back(i);
    feed.restarts_here = 0;
    if (config.reset == DropReset::kMap) {
      system.reset();
      feed.mapped = false;
    }
  }
  if (outcome.calls.empty() && outcome.skipped.count > 0)
    throw InputError(outcome.skipped.reasons.front());
  return outcome;
}

}  // namespace mh
