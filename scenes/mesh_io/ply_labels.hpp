// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/mesh_io/ply.hpp"
#include "scenes/scene.hpp"

namespace mh {

/// Gives the faces of a scene the classes and objects that its PLY tells:
/// - face property `object_id` (Replica): the object; classes by name from info_semantic.json
///   beside the mesh, or in habitat/ beside it;
/// - vertex properties `objectId` and `NYU40` (3RScan), names from semseg.v2.json or semseg.json
///   beside it;
/// - vertex property `label`: NYU40 ids.
/// A face takes what most of its vertices have, the first's where all differ. Ids that mean nothing
/// are left out and warned about with a count.
/// @param positions_m of the mesh are in the scene already
/// @throws InputError naming a JSON file that is damaged.
void label_ply(Scene& scene, const PlyMesh& mesh, const std::filesystem::path& file,
               std::vector<std::string>* warnings);

}  // namespace mh
