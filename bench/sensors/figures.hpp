// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/pictures/plot.hpp"

namespace mh {

/// The figure that each sensor model's source gives (lines) beside what the model does when it is
/// measured (dots). Takes some seconds.
std::vector<Plot> sensor_figures();

}  // namespace mh
