// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scenes/gazebo/unique_warnings.hpp"

namespace mh::gazebo {

/// A world in pieces that can be read one after the other, since libsdformat takes 4 MB per model
/// of a document. If poses are relative to frames of the world, there is a single piece. Includes
/// are expanded, and each URI is resolved from the file that contains it and written as a path;
/// names are unique; materials of Ogre scripts are written as `diffuse` and albedo map. Invisible
/// content is omitted (inertia, collisions, sensors, plugins, unreferenced joints).
///
/// If model://sun and model://ground_plane are missing, they are replaced by a light from above and
/// a gray 100 m plane. Other missing models and meshes are omitted with a warning.
/// @param visuals  number of visuals in the world
/// @throws InputError naming file and place: invalid XML, circular includes or more than 10,000 of
/// them.
struct Expanded {
  std::string scene;  ///< the world's element `scene`; empty if it has none
  std::vector<std::vector<std::string>> pieces;  ///< elements of the world, mainly its models
  std::size_t visuals = 0;
};
Expanded expand(const std::filesystem::path& world, UniqueWarnings& collected);

/// An SDF document of a world with these elements.
std::string document_of(const std::string& scene, std::span<const std::string> elements);

}  // namespace mh::gazebo
