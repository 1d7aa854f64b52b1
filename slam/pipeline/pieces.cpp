// SPDX-License-Identifier: Apache-2.0
#include "slam/pipeline/pieces.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace mh {
namespace {

constexpr double kSecond_ns = 1e9;

using TrackedFrames = std::map<Stamp, TrackedFrame>;

KeyframeId piece_of(const SlamState& state, TrackedFrames::const_iterator frame) {
  return state.map.at(frame->second.reference).origin;
}

/// The camera's pose at a later time, extrapolated from its motion during the last 0.2 s before the
/// frame.
SE3 moved_on(const SlamState& state, TrackedFrames::const_iterator frame, Stamp stamp_ns) {
  constexpr Stamp kBefore_ns = 200'000'000;
  const SE3 now = map_pose(state, frame->second).camera_from_world;
  auto before = frame;
  while (before != state.tracked_frames.begin() && frame->first - before->first < kBefore_ns &&
         piece_of(state, std::prev(before)) == piece_of(state, frame))
    --before;
  if (before == frame) return now;
  const SE3 then = map_pose(state, before->second).camera_from_world;
  const double longer = static_cast<double>(stamp_ns - frame->first) /
                        static_cast<double>(frame->first - before->first);
  return SE3::exp((now * then.inverse()).log() * longer) * now;
}

/// An interval in which the camera saw nothing.
struct Gap {
  Eigen::Vector3d
      place_m;  ///< the camera's position at the end of the gap, in the world of the other piece
  double elapsed_s;
};

}  // namespace

std::optional<SE3> place_of_new_piece(const SlamState& state, Stamp stamp_ns) {
  const double patience_s = state.config.track.new_piece_after_s;
  if (patience_s == 0) return std::nullopt;
  const auto after = state.tracked_frames.lower_bound(stamp_ns);
  if (after != state.tracked_frames.end() && after->first == stamp_ns) return std::nullopt;
  if (after == state.tracked_frames.begin()) return std::nullopt;
  const auto before = std::prev(after);
  if (static_cast<double>(stamp_ns - before->first) < patience_s * kSecond_ns) return std::nullopt;
  return moved_on(state, before, stamp_ns);
}

bool is_reachable(const SlamState& state, KeyframeId origin, const MapPose& other) {
  const double max_speed_m_s = state.config.track.max_speed_m_s;
  if (max_speed_m_s == 0) return true;
  // One standard deviation is a constant plus a part that grows with time.
  constexpr double kLeast_m = 0.15, kLeast_rad = 0.15, kTurn_rad_s = 0.25;
  constexpr double kMostSigmas = 2, kMost_rad = 1.2;
  const SE3& other_from_own = other.camera_from_world;
  SE3 other_from_piece;   // estimated; "piece" is the one that the camera is in
  std::vector<Gap> gaps;  // since the camera was in the other piece
  bool was_there = false;
  const auto& frames = state.tracked_frames;
  for (auto frame = frames.begin(); frame != frames.end() && std::next(frame) != frames.end();
       ++frame) {
    const auto next = std::next(frame);
    const KeyframeId left = piece_of(state, frame), entered = piece_of(state, next);
    if (left == other.origin) {
      was_there = true;
      other_from_piece = SE3();
      gaps.clear();
    }
    if (left == entered || !was_there) continue;
    const SE3 expected =
        moved_on(state, frame, next->first);  // camera_from_world, in the world of piece `left`
    const SE3 there = map_pose(state, next->second).camera_from_world;
    other_from_piece = other_from_piece * expected.inverse() * there;
    const Eigen::Vector3d place_m = other_from_piece * there.inverse().translation();
    gaps.push_back({place_m, static_cast<double>(next->first - frame->first) / kSecond_ns});
    if (entered != origin) continue;
    double variance_m2 = 0, variance_rad2 = 0;
    for (const Gap& gap : gaps) {
      const double position_m = kLeast_m + 0.5 * max_speed_m_s * gap.elapsed_s;
      const double angle_rad = kLeast_rad + kTurn_rad_s * gap.elapsed_s;
      const double lever_m = (place_m - gap.place_m).norm();
      variance_m2 += position_m * position_m + angle_rad * angle_rad * lever_m * lever_m;
      variance_rad2 += angle_rad * angle_rad;
    }
    const double most_m = state.config.loop.joining_within_m;
    if (most_m > 0 && (kMostSigmas * std::sqrt(variance_m2) > most_m ||
                       kMostSigmas * std::sqrt(variance_rad2) > kMost_rad))
      return false;
    const double off_m = (other_from_own * there.inverse().translation() - place_m).norm();
    const double off_rad = angle_between_rad(other_from_own, other_from_piece);
    if (off_m * off_m > kMostSigmas * kMostSigmas * variance_m2 ||
        off_rad * off_rad > kMostSigmas * kMostSigmas * variance_rad2)
      return false;
  }
  return true;
}

}  // namespace mh
