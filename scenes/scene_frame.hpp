// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <optional>
#include <string_view>

#include "slam/io/yaml.hpp"

namespace mh {

enum class UpAxis { kY, kZ };

/// What a user states about the frame of a scene's files that the files do not.
struct SceneFrame {
  std::optional<UpAxis> up = {};         ///< none: y for glTF and DAE, otherwise z
  std::optional<double> floor_z_m = {};  ///< height of a level floor, after turning; none: detected
  friend auto operator<=>(const SceneFrame&, const SceneFrame&) = default;
};

inline constexpr double kFarthestFloor_m = 10000;

/// "y" or "z".
std::optional<UpAxis> up_axis(std::string_view name);
std::string_view name(UpAxis up);

/// Reads the keys `up` and `floor_z_m` of a mapping, both optional.
/// @throws InputError naming line and value.
SceneFrame read_scene_frame(YamlReader& yaml);

}  // namespace mh
