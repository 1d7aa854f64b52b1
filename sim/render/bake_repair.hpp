// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "sim/render/bake_points.hpp"

namespace mh {

using Colors = std::vector<Eigen::Vector3f>;

struct BakeSurface {
  const BakePoints& points;
  const VertexNeighbors& neighbors;
};

/// Fills vertices inside solids from their neighbors and smooths the indirect light.
/// @param inside     by vertex
/// @param smoothing  iterations
void repair(const std::vector<char>& inside, const BakeSurface& surface, int smoothing,
            Colors& direct, Colors& indirect);

}  // namespace mh
