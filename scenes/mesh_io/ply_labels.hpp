// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/mesh_io/ply.hpp"
#include "scenes/scene.hpp"

namespace mh {

/// Assigns classes and objects from a PLY to the faces of a scene:
/// - face property `object_id` (Replica): the object; its class comes from its name in
///   info_semantic.json next to the mesh, or in habitat/ next to it;
/// - vertex properties `objectId` and `NYU40` (3RScan), with the objects' names from semseg.v2.json
///   or semseg.json next to the mesh;
/// - vertex property `label`: NYU40 ids. A face takes the value that two or three of its vertices
/// share, or the first vertex's value if all differ. Unknown ids are ignored, with a warning that
/// counts them.
/// @pre the scene already has the mesh's positions_m
/// @throws InputError naming a damaged JSON file.
void label_ply(Scene& scene, const PlyMesh& mesh, const std::filesystem::path& file,
               std::vector<std::string>* warnings);

}  // namespace mh
