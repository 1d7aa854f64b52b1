// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mh::gazebo {

/// The subset of an Ogre script's material that is read.
struct OgreMaterial {
  std::string name;
  std::optional<std::array<float, 4>> diffuse;  ///< RGBA
  std::string texture;                          ///< a file's name; empty if there is no texture
};

/// Reads the materials of an Ogre script: for each, the first pass's `diffuse` and the first
/// `texture`, otherwise those of its parent (`material A : B`). Everything else is ignored.
std::vector<OgreMaterial> parse_ogre_script(std::string_view script);

/// The plain colors that Gazebo ships as "Gazebo/NAME"; nullopt for other names.
std::optional<OgreMaterial> stock_material(std::string_view name);

}  // namespace mh::gazebo
