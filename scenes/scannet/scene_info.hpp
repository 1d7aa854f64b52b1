// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Core>

namespace mh {

/// What we use of sceneXXXX_YY.txt, whose lines are `key = value`.
struct ScannetInfo {
  /// Turns the scan upright and along its walls; release v1 has none.
  std::optional<Eigen::Matrix4d> aligned_from_scan;
  std::string scene_type;  ///< e.g. "Bedroom / Hotel"; empty where it is not told
};

/// @throws InputError naming file and line.
ScannetInfo parse_scannet_info(std::string_view text, const std::string& name);

}  // namespace mh
