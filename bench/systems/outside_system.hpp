// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "bench/protocol/system.hpp"

namespace mh {

/// Receives what is wrong with a reply; throws an OutsideError.
using Refuse = std::function<void(const std::string& what)>;

/// Converts [x, y, z, qx, qy, qz, qw] to a transform. Refuses coordinates beyond kFarthestPose_m,
/// non-finite values and a quaternion far from unit length.
SE3 told_pose(const std::array<double, 7>& values, const Refuse& refuse);

/// Refuses a report if a candidate count exceeds that of an earlier step, if it has a pose and a
/// failure stage, if it has a keyframe or the stage kVerified but no pose, or if it has more
/// inliers than keypoints.
void check_told(const SystemReport& report, const Refuse& refuse);

/// The seed that an outside system receives: 31 bits of a frame's stream, which fit an int
/// everywhere.
inline int told_seed(RandomStream stream) {
  return static_cast<int>(stream.bits(0) >> 33);
}

/// An outside system that is queried frame by frame. The poses that it reports are kept here. It
/// has a single map, so only the most recently opened session may be fed.
class OutsideSystem : public System {
 public:
  SystemReport track(const RgbdFrame& frame, RandomStream stream) final;
  void reset() final;
  void freeze() final;
  Trajectory trajectory() const final;
  std::unique_ptr<RelocalizationSession> open_session() const final;

 protected:
  enum class Question { kTrack, kBlank, kRelocalize };
  /// Its reply to a frame, except for the status. @param session  0 with kTrack
  virtual SystemReport ask(Question what, std::uint64_t session, const RgbdFrame& frame,
                           RandomStream stream) const = 0;
  virtual void forget() = 0;  ///< forgets everything, including the map
  /// Ends the mapping. @returns the poses of the finished map, if it reports them
  virtual std::optional<Trajectory> end_mapping() = 0;
  virtual void begin_session(std::uint64_t) const {}
  [[noreturn]] virtual void fail(const std::string& what) const = 0;

 private:
  friend class OutsideSession;
  SystemReport reported(Question what, std::uint64_t session, const RgbdFrame& frame,
                        RandomStream stream, TrackStatus with_pose) const;
  void take(const Trajectory& finished);
  /// Stamp at which a session begins: a second after the last frame of the mapping.
  Stamp after_mapping_ns() const {
    constexpr Stamp kSecond_ns = 1'000'000'000;
    return shown_.empty() ? 0 : *shown_.rbegin() + kSecond_ns;
  }

  std::map<Stamp, TimedPose> poses_;
  std::set<Stamp> shown_;
  bool frozen_ = false;
  mutable std::uint64_t sessions_ = 0;
};

}  // namespace mh
