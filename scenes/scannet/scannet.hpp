// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace mh {

/// Reads a ScanNet scene, of release v2 or v1: the folder, or its *_vh_clean_2.ply.
///
/// Positions are transformed by the scene's axisAlignment, which v1 lacks. The instance of a vertex
/// is the object (objectId + 1) whose segments it belongs to, the last one if several claim it. Its
/// class is that of the object's category in the label table; without an object, the mesh's own
/// `label` is used, a raw category id in v1. In v2 that label is an NYU40 id and takes precedence
/// over the category if the two contradict each other. A face takes the class that at least two of
/// its vertices have or, if all three differ, that of the first vertex. Likewise for the instance,
/// but if all three differ, it is that of the vertex from which the class was taken. Objects of a
/// category that is not in the table are unlabeled.
///
/// The mesh alone is also a valid scene. What is missing or unknown is reported in `warnings`, with
/// counts.
/// @throws InputError naming file and place if a file is damaged or does not fit the mesh.
Scene load_scannet(const std::filesystem::path& folder,
                   std::vector<std::string>* warnings = nullptr);

/// The names that save_scannet() writes into that folder.
std::vector<std::string> saved_scannet_names(const std::filesystem::path& folder);

/// Writes a scene as a folder of ScanNet's release v2, so that ScanNet's tools can read it: mesh,
/// labels, segments, aggregation, txt and label table. The scene's id is the folder's name.
/// Textures and light become vertex colors; to represent them, faces of scenes with textures or
/// light are split until no edge is longer than max_edge_m (0 = not split). Vertices where faces of
/// several objects meet are written once for each object, so that load_scannet restores every
/// face's class and instance. Classes that NYU40 lacks (those above 41) are preserved for faces
/// that belong to an object.
/// @throws InputError if a file cannot be written or the scene is inconsistent.
void save_scannet(const Scene& scene, const std::filesystem::path& folder,
                  float max_edge_m = 0.04F);

}  // namespace mh
