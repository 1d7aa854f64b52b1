// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Core>

namespace mh {

/// The parts of sceneXXXX_YY.txt that we use; its lines are `key = value`.
struct ScannetInfo {
  /// Aligns the scan with gravity and with its walls; missing in release v1.
  std::optional<Eigen::Matrix4d> aligned_from_scan;
  std::string scene_type;  ///< e.g. "Bedroom / Hotel"; empty if not stated
};

/// @throws InputError naming file and line.
ScannetInfo parse_scannet_info(std::string_view text, const std::string& name);

}  // namespace mh
