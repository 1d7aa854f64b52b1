// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "robots/navigation/grid.hpp"

namespace mh {

/// Samples a path every `spacing_m` and rounds its corners: each sample moves toward the midpoint
/// of its neighbors, as long as it keeps the clearance that it had, or `clearance_m`. The ends stay
/// in place.
std::vector<Eigen::Vector2d> smoothed(const FloorGrid& grid,
                                      const std::vector<Eigen::Vector2d>& way, double clearance_m,
                                      double spacing_m = 0.05);

/// Length of a polyline, m.
double length_m(const std::vector<Eigen::Vector2d>& way);

}  // namespace mh
