// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "slam/core/camera.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/trajectory.hpp"
#include "slam/occupancy/occupancy.hpp"

namespace mh {

/// Depth of keyframes, kept until their poses are final: 1/16 of the pixels.
class KeyframeDepths {
 public:
  /// A frame seen again (after a rewind) replaces the earlier one.
  void keep(const RgbdFrame& frame);

  /// The octree of all kept frames that have a pose in `estimate`, in the frame of
  /// map_from_estimate, inserted in order of stamps.
  std::shared_ptr<const OccupancyMapper> integrate(const Camera& camera, const Trajectory& estimate,
                                                   const SE3& map_from_estimate) const;

 private:
  struct Kept {
    Stamp stamp_ns = 0;
    Grid2d<float> depth_m;
  };
  std::vector<Kept> kept_;  // ordered by stamp
};

}  // namespace mh
