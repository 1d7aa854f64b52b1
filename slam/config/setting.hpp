// SPDX-License-Identifier: Apache-2.0
#pragma once

// How the settings of SLAM are listed. Each file of this folder holds one section of a settings
// file: a struct with the defaults, and beside it the list of its fields with name, range and
// meaning. Checks, settings files, suites, sweeps, map files and the table of the docs are made
// from the lists. A list's brackets name every field, so that a field without a line does not
// compile.

#include "slam/core/fields.hpp"

namespace mh {

/// The values that a setting may take: [min, max], or [min, max) where open.
struct SettingRange {
  double min = 0, max = 1;
  bool open = false;
};

namespace setting {
inline constexpr double kMany = 1e6;
inline constexpr SettingRange kShare{0, 1}, kOpenShare{0, 1, true}, kCount{1, kMany},
    kPoints{4, kMany}, kBits{0, 256}, kGray{1, 255}, kLength_m{0, 1000}, kRadius_px{1, 1000},
    kAngle_rad{0, 3.2}, kGate{1e-3, kMany}, kSwitch{0, 1};
}  // namespace setting

}  // namespace mh
