// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "scenes/mesh_io/label_rules.hpp"
#include "scenes/mesh_io/mtl_textures.hpp"
#include "scenes/scene.hpp"

struct aiScene;

namespace mh {

/// Properties of a file format.
struct MeshFormat {
  bool ply = false, gltf = false, obj = false, dae = false, y_up = false;
};

/// A file that assimp has read.
struct ReadMesh {
  const aiScene& scene;
  const std::filesystem::path& file;
  const MeshFormat& format;
  const LabelRules& rules;
  const std::map<std::string, MtlUvs>& uvs;  ///< by material; others keep the file's coordinates
};

/// Collects the meshes of a file's nodes into one scene, with their objects and classes (see
/// load_mesh). Does not convert materials: the scene must already have those of the file.
/// @throws InputError naming the file: positions that are not finite, too many objects or
/// materials.
void gather(const ReadMesh& mesh, Scene& scene);

}  // namespace mh
