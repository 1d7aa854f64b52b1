// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/peaks.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace mh {

void PeakMeter::add(const BaseState& state, const WheelBase* wheels) {
  const Eigen::Vector2d a = (state.velocity_m_per_s - before_.velocity_m_per_s) / step_s_;
  const double turn_a = (state.turn_rad_per_s - before_.turn_rad_per_s) / step_s_;
  const auto raise = [](double& peak, double value) { peak = std::max(peak, std::abs(value)); };
  raise(peaks_.m_per_s, state.velocity_m_per_s.norm());
  raise(peaks_.rad_per_s, state.turn_rad_per_s);
  raise(peaks_.m_per_s2, a.norm());
  raise(peaks_.rad_per_s2, turn_a);
  raise(peaks_.m_per_s3, (a - a_before_).norm() / step_s_);
  raise(peaks_.rad_per_s3, (turn_a - turn_a_before_) / step_s_);
  if (wheels != nullptr) {
    const Eigen::Vector2d in_base = Eigen::Rotation2Dd(-state.heading_rad) * state.velocity_m_per_s;
    raise(peaks_.rim_m_per_s,
          rim_speeds_m_per_s(*wheels, {in_base.x(), in_base.y(), state.turn_rad_per_s})
              .cwiseAbs()
              .maxCoeff());
  }
  before_ = state;
  a_before_ = a;
  turn_a_before_ = turn_a;
}

void PeakMeter::pushed(const BaseState& state) {
  before_ = state;
  a_before_.setZero();
  turn_a_before_ = 0;
}

}  // namespace mh
