// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <optional>

#include "slam/io/fields.hpp"
#include "slam/io/words.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

enum class UpAxis { kY, kZ };
constexpr Names<UpAxis, 2> words(UpAxis) {
  return {{{"y", UpAxis::kY}, {"z", UpAxis::kZ}}};
}

/// What the user states about the frame of a scene's files, because the files do not state it.
struct SceneFrame {
  std::optional<UpAxis> up = {};         ///< none: y for glTF and DAE, otherwise z
  std::optional<double> floor_z_m = {};  ///< height of a level floor, after turning; none: detected
  friend auto operator<=>(const SceneFrame&, const SceneFrame&) = default;
};

template <MaybeConst<SceneFrame> F, class Visit>
void fields(F& frame, Visit& v) {
  auto& [up, floor_z_m] = frame;
  v("up", up);
  v("floor_z_m", floor_z_m);
}

inline constexpr double kFarthestFloor_m = 10000;

/// Reads the keys `up` and `floor_z_m` of a mapping, both optional.
/// @throws InputError naming line and value.
SceneFrame read_scene_frame(YamlReader& yaml);

}  // namespace mh
