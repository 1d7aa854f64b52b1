// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/mesh_io/label_rules.hpp"
#include "scenes/scene.hpp"
#include "scenes/scene_frame.hpp"

namespace mh {

class ImageStore;

/// Context in which a mesh file is read.
struct MeshUse {
  ImageStore* images = nullptr;  ///< caches textures for other files of the same scene
  bool in_gazebo = false;        ///< ignores Collada's up axis: z is up
};

/// Reads a mesh file through assimp: PLY, glTF/GLB, OBJ, DAE (and other formats that assimp reads).
/// The result is z-up: glTF and DAE, which are y-up, are rotated; the others are left as they are.
///
/// Textures may be embedded or next to the file. Textures that are missing or cannot be decoded are
/// replaced by magenta and named in `warnings`. Texels that are not opaque are holes
/// (Material::opacity); a mostly transparent material is a pane (Material::transmission).
///
/// Class and instance come from
/// - the side file <stem>.labels.json of a PLY, as save_scannet_ply writes it;
/// - node names `name#class=CLASS#instance=ID`, as save_glb writes them, or glTF node extras
///   `class` (a name or an id) and `instance`;
/// - a side table <stem>.labels.yaml or labels.yaml next to the mesh, pattern -> class, for names
///   of nodes, meshes and materials (LabelRules); a node whose pieces are of several classes
///   becomes one instance per class;
/// - otherwise the node's name: "kitchen/night_stand_2" is a night stand; every node is an
///   instance.
///
/// Vertex colors of a file written by save_glb are baked light and are read into Scene::light;
/// those of other files are Scene::colors.
/// @param warnings  where to append one line per repaired flaw; may be null.
/// @param rules     rules that take precedence over those of the side table
/// @throws InputError for a missing file, no mesh, no faces, positions that are not finite, or
/// labels that do not fit the mesh.
Scene load_mesh(const std::filesystem::path& file, std::vector<std::string>* warnings = nullptr,
                const LabelRules& rules = {}, const MeshUse& use = {});

/// The same for a file whose up axis is given.
Scene load_turned_mesh(const std::filesystem::path& file, std::optional<UpAxis> up,
                       std::vector<std::string>* warnings = nullptr, const LabelRules& rules = {},
                       const MeshUse& use = {});

/// Writes a ScanNet-like mesh: binary little-endian PLY with x y z (float) and red green blue alpha
/// (uchar, sRGB) per vertex, faces as `uchar int vertex_indices`. The color of a vertex is its
/// visible color: texture x base color x vertex color x baked light, plus emission; if a vertex
/// belongs to several materials, that of its first face counts.
///
/// Next to it, <stem>.labels.json: {"format": "modelhouse-labels", "version": 1, "name",
/// "vertices": count, "faces": count, "instances": [[id, class name, name], ...], "runs": [[count,
/// instance id, class name], ...] over the faces in file order, "rooms": [[name, [[x, y], ...]],
/// ...]}.
/// @throws InputError if a file cannot be written.
void save_scannet_ply(const Scene& scene, const std::filesystem::path& file,
                      float max_edge_m = 0.04F);

/// Writes a binary glTF 2.0 with embedded PNG textures, y-up as glTF requires, one node per
/// instance (and class) named `name#class=CLASS#instance=ID` with extras `class` and `instance`,
/// and baked light times vertex color as linear vertex colors (they may exceed 1) of unlit
/// materials. Lamps and tile sizes are not kept; when the file is loaded, rooms are the boxes of
/// the floors.
/// @throws InputError if the file cannot be written or would exceed glTF's 4 GiB.
void save_glb(const Scene& scene, const std::filesystem::path& file);

}  // namespace mh
