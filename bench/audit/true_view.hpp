// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "sim/render/renderer.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/grid2d.hpp"
#include "slam/core/se3.hpp"
#include "slam/features/features.hpp"

namespace mh {

/// Two points are on the same surface if they are no farther apart than kSamePoint_m or, if that is
/// more, kSamePointShare of their depth.
inline constexpr double kSamePoint_m = 0.08;
inline constexpr double kSamePointShare = 0.04;

/// Ground truth of what a keypoint shows.
struct TruePoint {
  Eigen::Vector3d in_world;
  double depth_m = 0;      ///< in the view that it was seen in
  bool at_border = false;  ///< at most kBorder_px from a border between classes
};
inline constexpr int kBorder_px = 3;

/// The exact surface that a camera sees.
struct TrueView {
  SE3 world_from_camera;  ///< true
  Camera camera;          ///< without lens distortion
  Grid2d<float> depth_m;  ///< at every kStep-th pixel and row; 0 = nothing hit
  std::vector<std::optional<TruePoint>> points;  ///< by feature; none where nothing is hit

  static constexpr int kStep = 4;
};

/// A camera as SLAM knows it, without distortion, and a pinhole camera that sees at least as much.
struct TrueCamera {
  explicit TrueCamera(const Camera& camera);
  Camera camera, wide;
};

/// Renders what a camera at a true pose sees, and looks up what its keypoints show. A keypoint that
/// straddles two surfaces shows the nearer one, as in SLAM.
/// @param features  of the frame taken there (undistorted); with a rolling shutter they are off by
///                  the camera's motion within the frame, which is not corrected
TrueView look(const Renderer& renderer, const TrueCamera& camera, const SE3& world_from_camera,
              const Features& features);

/// Whether two keypoints show the same place.
bool same_place(const TruePoint& a, const TruePoint& b);

/// Share, in [0, 1], of the surface in `view` that `other` also shows. Computed over the points
/// behind a regular grid of pixels: those that, projected into `other`, agree with its depth. 0 if
/// `view` shows nothing.
double co_visible_share(const TrueView& view, const TrueView& other);

}  // namespace mh
