// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/sensors/config.hpp"

namespace mh {

/// The far end of the dial of difficulty: what is published of cameras in somebody's hand at their
/// worst. Light and exposure together set the gain.
struct Difficult {
  /// Exposure control that suppresses the flicker of mains light at 50 Hz takes multiples of 10 ms;
  /// 30 is the longest that 30 frames per second leave (OmniVision OV7675 data sheet, 4).
  double exposure_ms = 30;
  /// Light, as a share of what the level expects: 100 lx for 500 lx, what EN 12464-1 asks of
  /// corridors and of offices.
  double light = 0.2;
  /// Speed, as a multiple of the path's: a scan's median of 0.22 m/s and 13 deg/s becomes that of
  /// EuRoC's difficult sequences, 0.75 m/s and 0.66 rad/s (Burri et al., IJRR 2016, table 2).
  double speed = 3;
};

/// Returns a level that is harder by one dial: exposure time, light, gain, and speed go from the
/// level's own (0) to Difficult's (1), each by equal ratios. Monotone in each.
/// @throws InputError if `difficulty` is not in [0, 1], or the level has no motion blur, or its
/// shot
///         noise does not follow the light (gain_at_exposure)
SensorConfig at_difficulty(SensorConfig level, double difficulty);

}  // namespace mh
