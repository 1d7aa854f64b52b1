// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "slam/core/rgbd_frame.hpp"

namespace mh {

// Files of EuRoC's layout (Burri et al., "The EuRoC micro aerial vehicle datasets", IJRR 2016).

inline constexpr std::string_view kEurocImuColumns =
    "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
    "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]";
std::string euroc_line(const ImuReading& reading);

}  // namespace mh
