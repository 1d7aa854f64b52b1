// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "slam/core/ids.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/features/features.hpp"

namespace mh {

struct Observation {
  KeyframeId keyframe;
  std::uint32_t feature = 0;
  friend bool operator==(const Observation&, const Observation&) = default;
};

/// A landmark. The members that every search reads come first, so that they fit into a cache line
/// or two.
struct Landmark {
  Eigen::Vector3d position_in_world = Eigen::Vector3d::Zero();

  // Derived from the observations by Map::refresh().
  Eigen::Vector3d mean_direction = Eigen::Vector3d::UnitZ();  ///< mean over observations, from
                                                              ///< camera to landmark
  double min_distance_m = 0,
         max_distance_m = 0;  ///< range of distances at which the pyramid's levels can match it
  LandmarkId id;
  ClassId label = kVoid;  ///< of the observation that supplies the descriptor
  bool erased = false;
  bool described = false;   ///< descriptor and label were computed from the current observations;
                            ///< not saved to files
  Descriptor descriptor{};  ///< the observed one with the least median distance to the others

  std::vector<Observation> observations;  ///< ordered by keyframe, one per keyframe
  KeyframeId first_keyframe;
  int visible = 1;  ///< frames in which it was expected to be seen
  int found = 1;    ///< frames in which it was an inlier
};

}  // namespace mh
