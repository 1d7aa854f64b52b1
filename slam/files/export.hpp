// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "slam/map/map.hpp"

namespace mh {

/// Landmarks as a PLY point cloud (text): x y z (m, map frame), red green blue of the class, label
/// (class id), observations (number of keyframes that see it).
std::string landmarks_ply(const Map& map);

/// Keyframes as PLY (text): camera positions as vertices with the number of landmarks seen,
/// covisibility as edges with the number of landmarks shared.
std::string keyframes_ply(const Map& map);

/// Keyframes and covisibility as JSON: `keyframes` with id, stamp_ns, position_m and
/// quaternion_xyzw (camera to world), landmarks; `edges` with a < b and shared.
std::string keyframes_json(const Map& map);

}  // namespace mh
