// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/drawing/plot.hpp"

namespace mh {

// The figure that each sensor model's source gives (lines) beside what the model does when it is
// measured (dots). Some seconds in all.
std::vector<Plot> depth_figures();
std::vector<Plot> light_figures();
std::vector<Plot> label_figures();

}  // namespace mh
