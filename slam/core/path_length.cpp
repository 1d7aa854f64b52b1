// SPDX-License-Identifier: Apache-2.0
#include "slam/core/path_length.hpp"

namespace mh {

double path_length_m(const Trajectory& trajectory) {
  double length = 0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) length += step_length_m(trajectory, i);
  return length;
}

double step_length_m(const Trajectory& trajectory, std::size_t i) {
  return (trajectory[i].world_from_camera.translation() -
          trajectory[i - 1].world_from_camera.translation())
      .norm();
}

}  // namespace mh
