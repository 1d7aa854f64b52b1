// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/difficulty.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "slam/io/error.hpp"

namespace mh {

SensorConfig at_difficulty(SensorConfig level, double difficulty) {
  if (!(difficulty >= 0 && difficulty <= 1))
    throw InputError(fmt::format("difficulty {:g} is not in [0, 1]", difficulty));
  if (!level.motion_blur.enabled || !level.shot_noise.enabled ||
      level.shot_noise.gain_at_exposure <= 0)
    throw InputError(
        "difficulty needs a level with motion_blur and with shot_noise that follows the light "
        "(gain_at_exposure above 0), as in 'handheld'");
  const Difficult far;
  const double longest_ms = std::max(far.exposure_ms, level.motion_blur.exposure_ms);
  const double longer = std::pow(longest_ms / level.motion_blur.exposure_ms, difficulty);
  level.motion_blur.exposure_ms *= longer;
  // A longer exposure collects more of what light is left; gain makes up for the rest.
  level.shot_noise.gain_at_exposure *= std::pow(far.light, difficulty) * longer;
  level.hurry.speed = level.hurry.factor() * std::pow(far.speed, difficulty);
  level.hurry.enabled = level.hurry.speed > 1;
  return level;
}

}  // namespace mh
