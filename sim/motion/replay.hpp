// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scenes/scene.hpp"
#include "sim/motion/motion.hpp"
#include "slam/core/camera.hpp"

namespace mh {

struct ReplayConfig {
  /// Placement of the first pose: x, y (m), and the rotation about z (rad) of the whole trajectory.
  /// nullopt: the first of the seeded placements along which the camera touches nothing.
  std::optional<Eigen::Vector3d> at;
  std::uint64_t seed = 0;
  double room_m = 0.12;  ///< the camera keeps at least this far from everything
};

/// Moves a camera through a scene along a recorded trajectory (z up, as in TUM's), sampled at the
/// camera's rate. The whole trajectory is translated horizontally and rotated about z, so its
/// heights do not change. Between two poses the camera moves by a constant twist. Stamps start at
/// 0. DrivenPath::moved describes where the poses were moved.
/// @param name  name of the trajectory, for messages
/// @throws InputError if the trajectory has fewer than two poses, or no placement in the scene is
/// clear of everything.
DrivenPath replay(const Scene& scene, const Camera& camera, const Trajectory& recorded,
                  const std::string& name, const ReplayConfig& config = {});

/// Whose poses a file holds: world_from_camera (z forward), or world_from_base (x forward, z up).
enum class PosesOf { kCamera, kRobot };

/// A path with exactly these poses and stamps, in the scene's world. The head is at rest.
DrivenPath as_given(const Trajectory& poses, PosesOf of, const SE3& base_from_camera);

}  // namespace mh
