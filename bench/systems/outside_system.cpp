// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/outside_system.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/protocol/query.hpp"
#include "bench/systems/outside_error.hpp"
#include "slam/core/trajectory_io.hpp"

namespace mh {

SE3 told_pose(const std::array<double, 7>& v, const Refuse& refuse) {
  const std::string text = fmt::format("[{}]", fmt::join(v, ", "));
  if (!std::ranges::all_of(v, [](double x) { return std::isfinite(x); }))
    refuse(fmt::format("gave a pose of {}: a number is not finite", text));
  for (std::size_t k = 0; k < 3; ++k)
    if (std::abs(v[k]) > kFarthestPose_m)
      refuse(fmt::format("gave a pose more than {:g} m away: {}", kFarthestPose_m, text));
  const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
  if (std::abs(rotation.norm() - 1.0) > 0.1)
    refuse(fmt::format("gave a pose whose quaternion has norm {:g}", rotation.norm()));
  return SE3(rotation, Eigen::Vector3d(v[0], v[1], v[2]));
}

void check_told(const SystemReport& report, const Refuse& refuse) {
  const auto stage = report.relocalization;
  if (stage && report.world_from_camera && stage != RelocalizationStage::kNone &&
      stage != RelocalizationStage::kVerified)
    refuse(fmt::format("gave a pose and the stage \"{}\", which is one of failure", name(*stage)));
  if (stage == RelocalizationStage::kVerified && !report.world_from_camera)
    refuse(fmt::format("gave the stage \"{}\" without a pose", name(*stage)));
  if (report.keyframe_added && !report.world_from_camera) refuse("gave a keyframe without a pose");
  if (report.inliers && report.keypoints && *report.inliers > *report.keypoints)
    refuse(fmt::format("gave {} inliers of {} keypoints", *report.inliers, *report.keypoints));
  const Candidates& c = report.candidates;
  std::optional<int> left;
  for (const std::optional<int>& number : {c.keyframes, c.c1, c.c2, c.c3, c.final}) {
    if (!number) continue;
    if (left && *number > *left)
      refuse(fmt::format(
          "gave candidates of {} after {}: a step cannot leave more than the one before it",
          *number, *left));
    left = number;
  }
}

class OutsideSession : public RelocalizationSession {
 public:
  OutsideSession(const OutsideSystem& system, std::uint64_t number)
      : system_(system), number_(number) {}
  SystemReport feed(const RgbdFrame& frame, RandomStream stream) override {
    assert(number_ == system_.sessions_);  // the program keeps no older session
    using enum OutsideSystem::Question;
    // Stamps are shifted: a held-out frame's own stamp, which lies between those of mapped frames,
    // would reveal its pose.
    if (!later_ns_) later_ns_ = system_.after_mapping_ns() - frame.stamp_ns;
    RgbdFrame shown = frame;
    shown.stamp_ns += *later_ns_;
    return system_.reported(is_blank(shown) ? kBlank : kRelocalize, number_, shown, stream,
                            TrackStatus::kRelocalized);
  }

 private:
  const OutsideSystem& system_;  // outlives its sessions
  const std::uint64_t number_;
  std::optional<Stamp> later_ns_;  ///< added to each stamp
};

SystemReport OutsideSystem::reported(Question what, std::uint64_t session, const RgbdFrame& frame,
                                     RandomStream stream, TrackStatus with_pose) const {
  SystemReport report = ask(what, session, frame, stream);
  check_told(report, [this](const std::string& fault) { fail(fault); });
  if (report.map_reset && frozen_) fail("dropped a map that must not change any more");
  report.status = report.world_from_camera ? with_pose : TrackStatus::kLost;
  return report;
}

SystemReport OutsideSystem::track(const RgbdFrame& frame, RandomStream stream) {
  assert(!frozen_);
  shown_.insert(frame.stamp_ns);
  const SystemReport report = reported(Question::kTrack, 0, frame, stream, TrackStatus::kTracked);
  if (report.map_reset) poses_.clear();
  if (report.world_from_camera)
    poses_[frame.stamp_ns] = {frame.stamp_ns, *report.world_from_camera, report.map};
  else
    poses_.erase(frame.stamp_ns);  // the last attempt counts
  return report;
}

void OutsideSystem::reset() {
  forget();
  poses_.clear();
  shown_.clear();
}

void OutsideSystem::freeze() {
  const std::optional<Trajectory> finished = end_mapping();
  frozen_ = true;
  if (finished) take(*finished);
}

void OutsideSystem::take(const Trajectory& finished) {
  std::map<Stamp, TimedPose> poses;
  for (const TimedPose& pose : finished) {
    if (!shown_.contains(pose.stamp_ns))
      fail(fmt::format("gave a pose at {} in its trajectory, a frame that it never saw",
                       format_stamp(pose.stamp_ns)));
    poses.emplace(pose.stamp_ns, pose);
  }
  poses_ = std::move(poses);
}

Trajectory OutsideSystem::trajectory() const {
  Trajectory trajectory;
  for (const auto& [stamp_ns, pose] : poses_) trajectory.push_back(pose);
  return trajectory;
}

std::unique_ptr<RelocalizationSession> OutsideSystem::open_session() const {
  assert(frozen_);
  begin_session(++sessions_);
  return std::make_unique<OutsideSession>(*this, sessions_);
}

}  // namespace mh
