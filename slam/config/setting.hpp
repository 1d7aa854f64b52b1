// SPDX-License-Identifier: Apache-2.0
#pragma once

// Each file of this folder holds one section of the SLAM settings: a struct with its defaults and
// the list of its fields (slam/io/setting.hpp). Settings files, suites, sweeps, map files and the
// tables in the docs are generated from these lists.

#include "slam/io/setting.hpp"

namespace mh::setting {

inline constexpr SettingRange kPoints{4, kMany}, kBits{0, 256}, kGray{1, 255}, kRadius_px{1, 1000},
    kAngle_rad{0, 3.2}, kGate{1e-3, kMany};

}  // namespace mh::setting
