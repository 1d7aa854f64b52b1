// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace mh {

/// Reads a ScanNet scene, of release v2 or v1: the folder, or its *_vh_clean_2.ply.
///
/// Positions are turned by the scene's axisAlignment, which v1 lacks. The instance of a vertex is
/// the object (objectId + 1) whose segments it belongs to, the last one where several claim it. Its
/// class is the one that the label table gives the object's category; where it belongs to none, the
/// mesh's own `label` counts, a raw category id in v1. In v2 that label is an NYU40 id and goes
/// before the category where the two differ. A face takes the class, and the instance, that most of
/// its vertices have; where all three differ, the first vertex counts. Objects of a category that
/// the table lacks are unlabeled.
///
/// The mesh alone is a scene too. What is missing or unknown is told by `warnings`, with counts.
/// @throws InputError naming file and place where a file is damaged or does not fit the mesh.
Scene load_scannet(const std::filesystem::path& folder,
                   std::vector<std::string>* warnings = nullptr);

/// What save_scannet() writes into that folder.
std::vector<std::string> saved_scannet_names(const std::filesystem::path& folder);

/// Writes a scene as a folder of ScanNet's release v2, so that its tools can read it: mesh, labels,
/// segments, aggregation, txt and label table. The scene's id is the folder's name. Textures and
/// light go into the vertices' colors; to hold them, faces of scenes that have any are split until
/// no edge is longer than max_edge_m (0 = as they are). Vertices where faces of several objects
/// meet are written once for each, so that load_scannet gives every face its class and instance
/// back. Classes that NYU40 lacks (those above 41) are kept for faces that belong to an object.
/// @throws InputError if a file cannot be written or the scene is not sound.
void save_scannet(const Scene& scene, const std::filesystem::path& folder,
                  float max_edge_m = 0.04F);

}  // namespace mh
