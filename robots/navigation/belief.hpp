// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "robots/navigation/pose2.hpp"

namespace mh {

struct BeliefConfig {
  int agreeing = 5;         ///< agreeing answers in a row before they are accepted
  double agree_m = 0.15;    ///< largest distance between agreeing answers, given odometry
  double agree_rad = 0.12;  ///< largest difference of their headings
  double blind_m = 4.0;     ///< after driving this far without an accepted answer, it is lost
};

/// The robot's estimate of its pose in its map: the SLAM system's answers, extrapolated by wheel
/// odometry between them. An answer that agrees with the estimate is accepted; any other is
/// accepted only once several in a row agree with each other.
class PlaceBelief {
 public:
  explicit PlaceBelief(const BeliefConfig& config = {}) : config_(config) {}

  /// One frame. @param map_from_base  the system's answer, if it has one
  void see(const std::optional<Pose2>& map_from_base, const Pose2& odom_from_base);
  /// Forgets the place: the robot was carried.
  void forget() { *this = PlaceBelief(config_); }

  bool known() const { return map_from_odom_.has_value(); }
  /// @pre known()
  const Pose2& map_from_odom() const { return *map_from_odom_; }

 private:
  bool agrees(const Pose2& map_from_odom, const Pose2& map_from_base,
              const Pose2& odom_from_base) const;

  BeliefConfig config_;
  std::optional<Pose2> map_from_odom_, candidate_, before_;
  int in_a_row_ = 0;
  double blind_m_ = 0;
};

inline bool PlaceBelief::agrees(const Pose2& map_from_odom, const Pose2& map_from_base,
                                const Pose2& odom_from_base) const {
  const Pose2 expected = map_from_odom * odom_from_base;
  return (expected.place_m - map_from_base.place_m).norm() <= config_.agree_m &&
         std::abs(turn_to(expected.heading_rad, map_from_base.heading_rad)) <= config_.agree_rad;
}

inline void PlaceBelief::see(const std::optional<Pose2>& map_from_base,
                             const Pose2& odom_from_base) {
  if (before_) blind_m_ += (odom_from_base.place_m - before_->place_m).norm();
  before_ = odom_from_base;
  if (!map_from_base) {
    in_a_row_ = 0;
    if (blind_m_ > config_.blind_m) map_from_odom_.reset();
    return;
  }
  const Pose2 answered = *map_from_base * odom_from_base.inverse();
  in_a_row_ = candidate_ && in_a_row_ > 0 && agrees(*candidate_, *map_from_base, odom_from_base)
                  ? in_a_row_ + 1
                  : 1;
  candidate_ = answered;
  const bool expected = map_from_odom_ && agrees(*map_from_odom_, *map_from_base, odom_from_base);
  if (!expected && in_a_row_ < config_.agreeing) return;
  map_from_odom_ = answered;
  blind_m_ = 0;
}

}  // namespace mh
