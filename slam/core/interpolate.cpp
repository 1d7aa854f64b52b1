// SPDX-License-Identifier: Apache-2.0
#include "slam/core/interpolate.hpp"

#include <algorithm>
#include <iterator>

namespace mh {

std::optional<SE3> interpolated_pose(const Trajectory& trajectory, Stamp stamp_ns,
                                     Stamp max_gap_ns) {
  const auto after = std::ranges::lower_bound(trajectory, stamp_ns, {}, &TimedPose::stamp_ns);
  if (after != trajectory.end() && after->stamp_ns == stamp_ns) return after->world_from_camera;
  if (after == trajectory.begin() || after == trajectory.end()) return std::nullopt;
  const TimedPose& before = *std::prev(after);
  const Stamp gap_ns = after->stamp_ns - before.stamp_ns;
  if (gap_ns > max_gap_ns) return std::nullopt;
  const double share =
      static_cast<double>(stamp_ns - before.stamp_ns) / static_cast<double>(gap_ns);
  const SE3& a = before.world_from_camera;
  const SE3& b = after->world_from_camera;
  return SE3(a.quaternion().slerp(share, b.quaternion()),
             (1 - share) * a.translation() + share * b.translation());
}

}  // namespace mh
