// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sim/motion/reference.hpp"

namespace mh {

/// reference_motion() for a differential base. The base turns in place and drives along paths with
/// eased bends, facing its direction of travel. Distance and angle are smoothed as functions of
/// time, so that the base never leaves its path and never moves sideways; a stretch that would
/// exceed a limit in its bends is driven more slowly as a whole.
std::vector<Stretch> differential_motion(const Tour& tour, const BaseLimits& limits, double step_s,
                                         const WheelBase& wheels);

}  // namespace mh
