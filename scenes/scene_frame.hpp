// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <optional>
#include <string_view>

#include "slam/core/yaml.hpp"

namespace mh {

enum class UpAxis { kY, kZ };

/// What a user tells of the frame of a scene's files, which the files do not tell.
struct SceneFrame {
  std::optional<UpAxis> up = {};         ///< none: y for glTF and DAE, else z
  std::optional<double> floor_z_m = {};  ///< height of a level floor, after turning; none: found
  friend auto operator<=>(const SceneFrame&, const SceneFrame&) = default;
};

inline constexpr double kFarthestFloor_m = 10000;

/// "y" or "z".
std::optional<UpAxis> up_axis(std::string_view name);
std::string_view name(UpAxis up);

/// Reads the keys `up` and `floor_z_m` of a mapping, both of which may be missing.
/// @throws InputError naming line and value.
SceneFrame read_scene_frame(YamlReader& yaml);

}  // namespace mh
