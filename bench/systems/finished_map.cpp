// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/finished_map.hpp"

#include <sstream>

#include "slam/map/archive.hpp"

namespace mh {
namespace archive {

// Brackets name every field: a new one without a place here does not compile.
template <class A, Either<MappedFrame> T>
void fields(A& a, T& call) {
  auto& [index, stamp_ns, restart, status, inliers, keyframe_added, image_digest, matching_digest,
         pose_digest] = call;
  auto status_number = static_cast<int>(status);
  a(index, stamp_ns, restart, status_number, inliers, keyframe_added, image_digest, matching_digest,
    pose_digest);
  if constexpr (A::kReads) status = static_cast<TrackStatus>(status_number);
}
template <class A, Either<MatcherCounts> T>
void fields(A& a, T& counts) {
  auto& [compared, penalized, rejected_by_xi, ratio_helped] = counts;
  a(compared, penalized, rejected_by_xi, ratio_helped);
}
template <class A, Either<LoopClosure> T>
void fields(A& a, T& loop) {
  auto& [stamp_ns, old_stamp_ns, old_from_new] = loop;
  a(stamp_ns, old_stamp_ns, old_from_new);
}
template <class A, Either<SkippedFrames> T>
void fields(A& a, T& skipped) {
  auto& [count, reasons] = skipped;
  a(count, reasons);
}
template <class A, Either<MappingOutcome> T>
void fields(A& a, T& outcome) {
  auto& [calls, dropped, failures, restarts, before_map, gave_up, offered, matches, loops,
         skipped] = outcome;
  a(calls, dropped, failures, restarts, before_map, gave_up, offered, loops, skipped);
  for (auto& counts : matches) a(counts);
}

}  // namespace archive

std::string encode(const FinishedMap& map) {
  std::ostringstream volume;
  map.volume->write_bt(volume);
  archive::Writer writer;
  writer(map.outcome, map.system, volume.str());
  return writer.take();
}

FinishedMap decode_finished_map(const std::string& bytes, const std::string& name) {
  archive::Reader reader(bytes, name);
  FinishedMap map;
  std::string volume;
  reader(map.outcome, map.system, volume);
  reader.require(reader.at_end(), "it goes on after its end");
  std::istringstream stream(volume);
  map.volume = std::make_shared<const OccupancyMapper>(OccupancyMapper::read_bt(stream, name));
  return map;
}

}  // namespace mh
