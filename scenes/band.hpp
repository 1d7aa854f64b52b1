// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "scenes/scene.hpp"

namespace mh {

/// Visits the part of every face that is between two heights, as a convex polygon; faces outside
/// the band are skipped, and so is the floor (faces of a walkable class near z = 0).
/// @pre the scene's floor is z = 0 (LevelScene)
/// @param polygon  three to five corners, m, world, in the face's order
void for_each_face_in_band(
    const Scene& scene, float bottom_m, float top_m,
    const std::function<void(std::size_t face, std::span<const Eigen::Vector3f> polygon)>& visit);

}  // namespace mh
