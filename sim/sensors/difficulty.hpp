// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/sensors/config.hpp"

namespace mh {

/// Difficulty 1: the hardest published conditions for handheld cameras. Light and exposure together
/// set the gain.
struct Difficult {
  /// Exposure control that suppresses the flicker of mains light at 50 Hz takes multiples of 10 ms;
  /// 30 is the longest possible at 30 frames per second (OmniVision OV7675 data sheet, 4).
  double exposure_ms = 30;
  /// Light, as a share of what the level expects: 100 lx instead of 500 lx, which EN 12464-1
  /// requires in corridors and in offices, respectively.
  double light = 0.2;
  /// Multiple of the path's speed. It brings a scan's median of 0.22 m/s and 13 deg/s close to
  /// EuRoC's difficult sequences, 0.75 m/s and 0.66 rad/s (Burri et al., IJRR 2016, table 2).
  double speed = 3;
};

/// Returns a harder copy of `level`. Exposure time, light, gain and speed are interpolated
/// geometrically from the level's own values (difficulty 0) to Difficult's (1).
/// @throws InputError if `difficulty` is not in [0, 1], the level has no motion blur, or its shot
/// noise does not follow the light (gain_at_exposure)
SensorConfig at_difficulty(SensorConfig level, double difficulty);

}  // namespace mh
