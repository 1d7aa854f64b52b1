// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "scenes/scene.hpp"
#include "sim/motion/motion.hpp"
#include "slam/core/camera.hpp"

namespace mh {

/// How a person with a camera in both hands walks through a place to scan it. Speeds are chosen so
/// that the camera moves as in real recordings, never by a system's success rate: between frames at
/// 30 Hz, 0.035 / 0.13 / 0.22 / 0.30 / 0.42 m/s and 1.8 / 8 / 13 / 19 / 26 deg/s (percentiles 5,
/// 25, 50, 75, 95 of 7-Scenes' redkitchen).
struct HandheldConfig {
  std::uint64_t seed = 0;
  /// Number of frames, 30 to 100,000; nullopt: chosen by the area of free floor, 300 to 1,500.
  std::optional<std::size_t> frames = {};

  double height_m = 1.40;           ///< approximate camera height over the floor
  double walking_m_per_s = 0.25;    ///< median speed between pauses
  double turning_rad_per_s = 0.42;  ///< median of the turns' peaks
  /// One turn in this many is fast: 1.2 to 2.1 rad/s at its peak, as in TUM's fr1/rpy (67 deg/s
  /// median, 120 deg/s the 95th percentile). 0 = none.
  int fast_turn_every = 7;

  // The body moves up and down with each step and sideways with each stride, in proportion to the
  // walking speed: Orendurff et al., "The effect of walking speed on center of mass displacement",
  // J. Rehabil. Res. Dev. 41, 2004: 27.4 mm vertically, 69.9 mm laterally at 0.7 m/s. `gait` scales
  // both.
  double gait = 1.0;
  /// When standing, the body sways by about 5 mm RMS below 1 Hz (Prieto et al., "Measures of
  /// postural steadiness", IEEE Trans. Biomed. Eng. 43, 1996).
  double sway_rms_m = 0.005;
  /// Contribution of the hands: the camera's direction wanders below 2 Hz. Our choice.
  double wander_rms_rad = 0.005;
  /// Physiological tremor, 6 to 12 Hz (Lakie et al., J. Physiol. 593, 2015), 0.25 mm RMS for a
  /// braced handheld instrument (Becker, Tummala, Riviere, EMBC 2008, PMC3032442, figure 4). As an
  /// angle: at most what redkitchen's stillest frames allow (1.8 deg/s, the 5th percentile).
  double tremor_rms_m = 0.00025;
  double tremor_rms_rad = 0.0004;
};

/// Simulates a handheld scan of a place: a round trip through the free floor, repeated while time
/// is left, with pauses and occasional fast turns. The camera looks at furniture rather than at
/// bare walls, from 1.5 to 3 m if there is space (CubiCasa, "Best scanning practices"), and prefers
/// what has been seen least. It keeps clear of everything between knee and head height. A different
/// seed gives a different path through the same place. DrivenPath::base is the floor point below
/// the camera, facing the same direction.
/// @throws InputError if there is no floor, or no space on it for a person.
DrivenPath handheld_scan(const Scene& scene, const Camera& camera,
                         const HandheldConfig& config = {});

/// @throws InputError naming the field out of range.
void validate(const HandheldConfig& config);

}  // namespace mh
