// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "sim/render/renderer.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// The part of a scene's surface that the views along a path show.
class VisibleSurface {
 public:
  /// @param apart_m  minimum pose_distance() between the path's views that are used
  VisibleSurface(std::shared_ptr<const Renderer> renderer, const Camera& camera,
                 const Trajectory& path, double apart_m = 0.1);

  /// The share of a view's surface that at least one of the path's views shows: in its image, and
  /// not behind something by more than 8 cm or 4 % of the depth. 0 if no surface is visible.
  /// @param renderer  of the view's scene, which may differ from the path's
  double share(const Renderer& renderer, const SE3& world_from_camera) const;

 private:
  struct View {
    SE3 camera_from_world;
    Grid2d<float> depth_m;
  };
  Camera camera_, sparse_;  ///< for the path's views; for the view that is judged
  std::vector<View> views_;
};

}  // namespace mh
