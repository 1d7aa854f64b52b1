// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "slam/core/camera.hpp"
#include "slam/core/grid2d.hpp"
#include "slam/core/labels.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// One view's vote for the class of a voxel.
struct VoxelVote {
  std::uint16_t place = 0;  ///< in its block: x + 8 y + 64 z
  ClassId class_id = kVoid;
  /// Which voxels of the view belong together: each of its detections has its own number, which has
  /// no meaning in other views.
  std::uint8_t detection = 0;
  friend bool operator==(const VoxelVote&, const VoxelVote&) = default;
};

/// What one view observed of 8 x 8 x 8 voxels: bit x + 8 y + 64 z of a set is the voxel at (x, y,
/// z).
struct VoxelBlock {
  using Bits = std::array<std::uint64_t, 8>;        ///< one word per z
  Eigen::Vector3i index = Eigen::Vector3i::Zero();  ///< covers voxels [8 index, 8 index + 8)
  Bits free{}, hit{};                               ///< disjoint
  std::vector<VoxelVote> votes;  ///< of hit voxels with a class, ordered by place
};

/// What one view observed, ordered by block (z, then y, then x).
using VoxelView = std::vector<VoxelBlock>;

/// How depth becomes free and occupied space. A voxel is free if it lies in front of everything
/// that the image shows around the pixel of its center, so a voxel that is cut by a grazing surface
/// or by an edge is not free.
struct DepthModel {
  double resolution_m = 0.05;  ///< side of a voxel
  double min_range_m = 0.4;    ///< nearer returns are ignored; they are below the range of an Xtion
  /// A farther return only clears the space up to this range. 4 m: depth noise there (3 cm, Nguyen
  /// et al., 3DIMPVT 2012) is about a voxel. At most 250 times the resolution.
  double max_range_m = 4.0;
  /// How far around the pixel of a voxel's center the image must show nothing in the voxel or in
  /// front of it: half the side of the square that is checked, in voxels.
  double around_voxels = 0.5;
  /// How far behind a voxel's center all returns around it must be, in voxels along the optical
  /// axis.
  double before_voxels = 0.6;
};

/// Averages the depth of each pixel with those of its eight neighbors that lie on the same surface:
/// within three standard deviations of the noise. A pixel with fewer than two such neighbors floats
/// between two surfaces, as happens at edges, and its depth is discarded.
/// @param noise_per_m  the standard deviation is this times the squared depth. 0.0019: a Kinect's,
/// Nguyen et al., 3DIMPVT 2012
Grid2d<float> smoothed_depth(const Grid2d<float>& depth_m, double noise_per_m = 0.0019);

/// Labels of the pixels of a depth image; both grids have its size or are empty.
struct PixelLabels {
  Grid2d<ClassId> classes;  ///< kVoid = none
  Grid2d<std::uint8_t>
      detections;  ///< see VoxelVote; empty: all pixels of a class are one detection
};

/// What a depth image with its labels shows, in the frame of `map_from_camera`.
/// @param depth_m  along z, undistorted; 0 = no return, which is ignored
VoxelView look(const Grid2d<float>& depth_m, const PixelLabels& labels, const Camera& camera,
               const SE3& map_from_camera, const DepthModel& model);

}  // namespace mh
