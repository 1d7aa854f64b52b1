// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "slam/core/camera.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/trajectory.hpp"
#include "slam/occupancy/voxel_map.hpp"

namespace mh {

struct OccupancyConfig {
  DepthModel depth;
  int stride_px = 4;  ///< every n-th pixel of every n-th row is kept: 3 cm apart at 4 m
  /// Poses are rounded to multiples of these before they are used, so that a keyframe is integrated
  /// again only if it moved to a different multiple, and the map is a function of the poses alone.
  /// 5 mm and 1.25 mrad (5 mm at 4 m): a tenth of a voxel.
  double pose_step_m = 0.005, pose_step_rad = 0.00125;
};

/// Numbers of keyframes that an update added, moved, removed, and kept as they were.
struct OccupancyUpdate {
  std::size_t added = 0, moved = 0, removed = 0, kept = 0;
};

/// A voxel map that follows the poses of its keyframes: when a loop closure or an adjustment moves
/// them, their contributions are removed and added again. After each update, the map equals, to the
/// bit, a map built at once from the same keyframes at the same poses.
class OccupancyMapper {
 public:
  /// @throws InputError naming the setting that is out of range.
  explicit OccupancyMapper(const Camera& camera, const OccupancyConfig& config = {});

  /// Keeps depth and labels of a keyframe until update() gives it a pose. A frame replaces an
  /// earlier one with the same stamp. @throws InputError if the size is not the camera's.
  void keep(const RgbdFrame& frame);
  /// Makes the map agree with these poses: kept keyframes that have a pose are added or moved,
  /// those without one are removed from the map (but their depth and labels are still kept).
  /// @param map_from_world  the map's frame, z up
  OccupancyUpdate update(const Trajectory& world_from_camera, const SE3& map_from_world = {});

  /// Records in the map which objects its voxels belong to, according to the detections of all
  /// keyframes. Call it after the last update(): the next update discards it.
  void associate_detections();

  const VoxelMap& map() const { return map_; }
  VoxelMap take_map() && { return std::move(map_); }
  /// Depth of a keyframe, thinned to stride_px and smoothed; nullptr if unknown. Its camera is
  /// thin_camera().
  const Grid2d<float>* depth_of(Stamp stamp_ns) const;
  const PixelLabels* labels_of(Stamp stamp_ns) const;
  /// Stamps of all kept keyframes, in order.
  std::vector<Stamp> stamps() const;
  const Camera& thin_camera() const { return camera_; }

 private:
  struct Kept {
    Grid2d<float> depth_m;
    PixelLabels labels;
    std::optional<SE3> pose;  ///< at which it was integrated, rounded
    VoxelView told;
  };
  SE3 rounded(const SE3& map_from_camera) const;

  OccupancyConfig config_;
  int width_px_, height_px_;  ///< of frames
  Camera camera_;             ///< of thinned frames: a pinhole without distortion
  std::vector<std::size_t>
      pixel_;  ///< pixel of a frame from which each thinned pixel is taken, or kNoPixel
  VoxelMap map_;
  std::map<Stamp, Kept> kept_;
};

}  // namespace mh
