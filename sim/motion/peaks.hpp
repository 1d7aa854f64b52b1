// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robots/model/wheel_base.hpp"
#include "sim/motion/motion.hpp"
#include "sim/physics/planar_world.hpp"

namespace mh {

/// A deviation from the command by more than this means that the base was pushed.
inline constexpr double kPushed_m_per_s = 1e-3;

/// Records the base's peak motion between consecutive physics steps.
class PeakMeter {
 public:
  explicit PeakMeter(double step_s) : step_s_(step_s) {}
  /// @param wheels  null if the robot has none
  void add(const BaseState& state, const WheelBase* wheels);
  /// Notes that a contact changed the velocity, which does not count as an acceleration.
  void pushed(const BaseState& state);
  const DrivePeaks& peaks() const { return peaks_; }

 private:
  double step_s_;
  DrivePeaks peaks_;
  BaseState before_;
  Eigen::Vector2d a_before_ = Eigen::Vector2d::Zero();
  double turn_a_before_ = 0;
};

}  // namespace mh
