// SPDX-License-Identifier: Apache-2.0
#include "bench/run/frame_log.hpp"

#include <iterator>
#include <optional>

#include <fmt/format.h>

#include "slam/core/trajectory_io.hpp"

namespace mh {
namespace {

/// A CSV cell with its leading comma: ",3", or "," if unknown.
std::string cell(const std::optional<int>& count) {
  return count ? fmt::format(",{}", *count) : ",";
}

}  // namespace

void FrameLog::count(const SystemReport& report, int by) {
  if (report.status == TrackStatus::kLost) return;
  tracked += by;
  relocalized += report.status == TrackStatus::kRelocalized ? by : 0;
  loops += report.loop ? by : 0;
}

void FrameLog::add(const MappedFrame& call, const SystemReport& report) {
  if (report.map_reset) {
    ++map_resets;
    tracked = relocalized = loops = 0;
    for (auto& [index, frame] : frames_) {
      SystemReport lost;
      lost.keypoints = frame.keypoints;
      frame = lost;
    }
  }
  const auto [place, is_new] = frames_.try_emplace(call.index);
  if (!is_new) count(place->second, -1);
  place->second = report;
  count(report, 1);
  last_was_lost = report.status == TrackStatus::kLost;
}

std::string FrameLog::csv(const Sequence& sequence, const ProtocolConfig& config,
                          std::size_t first) const {
  std::string text =
      "stamp_s,status,keypoints,inliers,keyframe,loop,relocalization,keyframes,c1,c2,c3,final\n";
  for (std::size_t i = first; i < sequence.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{},", format_stamp(sequence.stamp_ns(i)));
    const auto found = frames_.find(i);
    if (found == frames_.end()) {
      text += is_test_frame(i, config) ? "held_out,,,,,,,,,,\n" : "skipped,,,,,,,,,,\n";
      continue;
    }
    const SystemReport& r = found->second;
    const Candidates& c = r.candidates;
    fmt::format_to(std::back_inserter(text), "{}{}{},{},{},{}", name(r.status), cell(r.keypoints),
                   cell(r.inliers), r.keyframe_added ? 1 : 0, r.loop ? 1 : 0,
                   name(r.relocalization.value_or(RelocalizationStage::kNone)));
    for (const auto& left : {c.keyframes, c.c1, c.c2, c.c3, c.final}) text += cell(left);
    text += '\n';
  }
  return text;
}

}  // namespace mh
