// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scenes/gazebo/told_once.hpp"

namespace mh::gazebo {

/// A world in pieces that can be read one after the other (libsdformat takes 4 MB for each model of
/// a document; one piece where poses count from frames of the world): what it includes stands in
/// its place, each URI seen from the file that names it and written as a path; names are unique;
/// materials of Ogre scripts are written as `diffuse` and albedo map. Left out is what does not
/// show (inertia, collisions, sensors, plugins, joints that nobody refers to).
///
/// Where model://sun and model://ground_plane are not there, they are a light from above and a gray
/// plane of 100 m. Other models and meshes that are not there are left out and told.
/// @param visuals  how many visuals it holds
/// @throws InputError naming file and place: no XML, includes in a circle or more than 10,000.
struct Expanded {
  std::string scene;                             ///< the element, or nothing
  std::vector<std::vector<std::string>> pieces;  ///< elements of the world, its models above all
  std::size_t visuals = 0;
};
Expanded expand(const std::filesystem::path& world, ToldOnce& told);

/// An SDF document of a world that holds these elements.
std::string document_of(const std::string& scene, std::span<const std::string> elements);

}  // namespace mh::gazebo
