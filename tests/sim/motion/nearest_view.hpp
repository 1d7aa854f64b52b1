// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "slam/core/trajectory.hpp"

namespace mh::test {

/// How different two views are: 1 rad counts as much as 1 m.
inline double view_distance(const SE3& a, const SE3& b) {
  return (a.translation() - b.translation()).norm() + angle_between_rad(a, b);
}

/// The median distance of a query to its nearest mapped view; every 30th frame of the query path is
/// a query.
inline double median_distance_to_nearest_view(const Trajectory& queries, const Trajectory& mapped) {
  std::vector<double> distances;
  for (std::size_t q = 0; q < queries.size(); q += 30) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const TimedPose& pose : mapped)
      nearest =
          std::min(nearest, view_distance(queries[q].world_from_camera, pose.world_from_camera));
    distances.push_back(nearest);
  }
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::ranges::nth_element(distances, middle);
  return *middle;
}

}  // namespace mh::test
