// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tinyxml2.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scenes/gazebo/find.hpp"
#include "scenes/gazebo/ogre_script.hpp"
#include "scenes/gazebo/unique_warnings.hpp"

namespace mh::gazebo {

/// Rewrites the materials of visuals to be self-contained: colors as `diffuse` and `emissive`, a
/// texture as the albedo map of a `pbr` with an absolute path.
class LookWriter {
 public:
  LookWriter(const Finder& finder, UniqueWarnings& collected)
      : finder_(finder), collected_(collected) {}

  /// @param material  as it is in `file`
  /// @param out       an empty `material`
  void write(const tinyxml2::XMLElement& material, const std::filesystem::path& file,
             tinyxml2::XMLElement& out);

 private:
  std::string texture_of_pbr(const tinyxml2::XMLElement& material,
                             const std::filesystem::path& file);
  /// Resolves a <script> to its material, with the texture's path.
  std::optional<OgreMaterial> material_of(const tinyxml2::XMLElement& script,
                                          const std::filesystem::path& file);
  const std::vector<OgreMaterial>& materials_in(const std::filesystem::path& script);

  const Finder& finder_;
  UniqueWarnings& collected_;
  std::map<std::filesystem::path, std::vector<OgreMaterial>> scripts_;
};

}  // namespace mh::gazebo
