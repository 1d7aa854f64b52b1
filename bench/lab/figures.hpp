// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/report/drawing/plot.hpp"

namespace mh {

// Figures of the sensor models: each source's published curve (lines) with measurements of our
// model (dots). All of them together take a few seconds.
std::vector<Plot> depth_figures();
std::vector<Plot> light_figures();
std::vector<Plot> label_figures();

}  // namespace mh
