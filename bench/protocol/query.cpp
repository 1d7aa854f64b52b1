// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/query.hpp"

#include <algorithm>

#include "bench/protocol/streams.hpp"
#include "bench/protocol/system_report.hpp"
#include "slam/core/digest.hpp"

namespace mh {
namespace {

/// Shows blank frames until the session reports that it is lost.
int lose(RelocalizationSession& session, const RgbdFrame& like, int at_most, RandomStream stream) {
  const RgbdFrame blank = blank_frame(like.color.width(), like.color.height(), like.stamp_ns);
  for (int shown = 1; shown <= at_most; ++shown)
    if (session.feed(blank, stream.fork(static_cast<std::uint64_t>(shown))).status ==
        TrackStatus::kLost)
      return shown;
  return at_most;
}

}  // namespace

RgbdFrame blank_frame(int width_px, int height_px, Stamp stamp_ns) {
  return {.stamp_ns = stamp_ns,
          .color = Grid2d<Rgb8>(width_px, height_px),
          .depth_m = Grid2d<float>(width_px, height_px),
          .semantics = {}};
}

bool is_blank(const RgbdFrame& frame) {
  return std::all_of(frame.depth_m.begin(), frame.depth_m.end(),
                     [](float depth_m) { return depth_m == 0; }) &&
         std::all_of(frame.color.begin(), frame.color.end(),
                     [](Rgb8 color) { return color == Rgb8{}; });
}

Presentation presentation(RandomStream stream, std::size_t index, int attempt, Attempts attempts) {
  const auto key = static_cast<std::uint64_t>(attempt);
  const std::uint64_t noise_key = attempts == Attempts::kNewNoise ? key : 0;
  return {stream.fork(RunDraw::kNoise).fork(index).fork(noise_key),
          stream.fork(RunDraw::kSlam).fork(index).fork(key)};
}

QueryAnswer query(const System& frozen, std::size_t index, const Sequence& sequence,
                  const ProtocolConfig& config, RandomStream stream, QueryMemo* memo) {
  const auto session = memo == nullptr ? frozen.open_session() : frozen.open_session_with(*memo);

  QueryAnswer answer;
  answer.index = index;
  RgbdFrame frame;
  for (int attempt = 0; attempt < config.query_attempts; ++attempt) {
    const auto [noise, draws] = presentation(stream, index, attempt, config.attempts);
    if (attempt == 0 || config.attempts == Attempts::kNewNoise)
      frame = usable_frame(sequence, index, noise);
    frame.odom_from_camera.reset();  // the robot was carried there
    if (attempt == 0)
      answer.blank_frames =
          lose(*session, frame, config.max_blank_frames, stream.fork(RunDraw::kBlank).fork(index));

    const SystemReport report = session->feed(frame, draws);
    ++answer.attempts;
    answer.stage = std::max(answer.stage, report.relocalization);
    if (attempt == 0) answer.candidates = report.candidates;
    add(report.matches, answer.matches);
    answer.image_digest = chained(answer.image_digest, digest(frame));
    answer.matching_digest = chained(answer.matching_digest, digest_of_matching(report));
    answer.pose_digest = chained(answer.pose_digest, digest(report.world_from_camera));
    if (report.status != TrackStatus::kLost && report.world_from_camera) {
      answer.world_from_camera = report.world_from_camera;
      answer.map = report.map;
      break;
    }
  }
  return answer;
}

std::vector<std::size_t> test_frames(std::size_t count, const ProtocolConfig& config) {
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < count; ++i)
    if (is_test_frame(i, config)) frames.push_back(i);
  return frames;
}

}  // namespace mh
