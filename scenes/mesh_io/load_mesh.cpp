// SPDX-License-Identifier: Apache-2.0
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "scenes/floor.hpp"
#include "scenes/guard.hpp"
#include "scenes/mesh_io/collada.hpp"
#include "scenes/mesh_io/gather.hpp"
#include "scenes/mesh_io/glow.hpp"
#include "scenes/mesh_io/gltf.hpp"
#include "scenes/mesh_io/instances_in.hpp"
#include "scenes/mesh_io/label_rules.hpp"
#include "scenes/mesh_io/labels_file.hpp"
#include "scenes/mesh_io/large_faces.hpp"
#include "scenes/mesh_io/materials_in.hpp"
#include "scenes/mesh_io/mesh_io.hpp"
#include "scenes/mesh_io/mtl_textures.hpp"
#include "scenes/mesh_io/noted_files.hpp"
#include "scenes/mesh_io/ply.hpp"
#include "scenes/mesh_io/ply_corners.hpp"
#include "scenes/mesh_io/ply_header.hpp"
#include "scenes/mesh_io/ply_labels.hpp"
#include "slam/io/error.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/files.hpp"
#include "slam/io/held_bytes.hpp"
#include "slam/io/lower_case.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace fs = std::filesystem;

namespace {

MeshFormat format_of(const fs::path& file) {
  const std::string ending = lower_case(file.extension().string());
  const bool gltf = ending == ".glb" || ending == ".gltf";
  return {.ply = ending == ".ply",
          .gltf = gltf,
          .obj = ending == ".obj",
          .dae = ending == ".dae",
          .y_up = gltf || ending == ".dae"};
}

const aiScene& read(Assimp::Importer& importer, const fs::path& file, const MeshUse& use,
                    MtlTextures& textures, std::vector<std::string>* warnings) {
  const MeshFormat format = format_of(file);
  require_readable(file);
  if (format.obj || format.dae) without_mark(map_file(file).view, file);  // throws on UTF-16
  std::map<fs::path, std::string> in_memory;
  if (format.gltf)
    if (auto repaired = repaired_gltf(map_file(file).view, file, warnings)) {
      in_memory[repaired->decoded_name] = std::move(repaired->decoded);
      in_memory[file] = std::move(repaired->bytes);
    }
  if (format.ply)
    if (auto split = ply_with_corners(map_file(file).view, file.string()))
      in_memory[file] = *std::move(split);
  importer.SetIOHandler(new NotedFiles(std::move(in_memory), textures));  // takes ownership
  // No step may reorder vertices or faces, since the labels file of a PLY refers to them by order.
  const unsigned steps =
      format.ply ? unsigned{aiProcess_Triangulate} : aiProcess_Triangulate | aiProcess_GlobalScale;
  const aiScene* in = nullptr;
  if (format.dae) {
    const std::string text = repaired_collada(map_file(file).view, use.in_gazebo);
    in = importer.ReadFileFromMemory(text.data(), text.size(), 0, "dae");
  } else {
    in = importer.ReadFile(file.string(), 0);
  }
  if (in != nullptr) {
    cut_large_faces(*in, file, warnings);
    in = importer.ApplyPostProcessing(steps);
  }
  if (in == nullptr || in->mRootNode == nullptr)
    throw InputError(fmt::format("{}: is not a mesh that can be read: {}", file.string(),
                                 importer.GetErrorString()));
  return *in;
}

/// assimp looks for an OBJ's materials in the file that mtllib names, then in one with the OBJ's
/// name, and silently continues without them.
void warn_of_missing_materials(const fs::path& file, std::vector<std::string>* warnings) {
  if (warnings == nullptr || is_there(fs::path(file).replace_extension(".mtl"))) return;
  const HeldBytes held = map_file(file);
  constexpr std::string_view kKey = "mtllib";
  for (std::size_t at = 0; (at = held.view.find(kKey, at)) != held.view.npos; at += kKey.size()) {
    std::string_view rest = held.view.substr(at + kKey.size());
    const bool begins_line = at == 0 || held.view[at - 1] == '\n';
    if (!begins_line || (!rest.starts_with(' ') && !rest.starts_with('\t'))) continue;
    rest = rest.substr(0, rest.find_first_of("\r\n"));
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    rest = rest.substr(0, rest.find_last_not_of(" \t") + 1);
    std::string portable(rest);
    std::ranges::replace(portable, '\\', '/');
    if (!is_there(file.parent_path() / portable))
      warnings->push_back(fmt::format("{}:{}: mtllib {} is missing: what it colors is gray",
                                      file.string(),
                                      1 + std::ranges::count(held.view.substr(0, at), '\n'), rest));
  }
}

/// Warns if a PLY has only face colors: only vertex colors are read.
void warn_of_face_colors(std::string_view bytes, const fs::path& file,
                         std::vector<std::string>* warnings) {
  const ply::Header header = ply::parse_header(bytes, file.string());
  const auto has_colors = [&](std::string_view name) {
    const auto element = std::ranges::find(header.elements, name, &ply::Element::name);
    return element != header.elements.end() && element->find("red") != nullptr;
  };
  if (warnings != nullptr && has_colors("face") && !has_colors("vertex"))
    warnings->push_back(
        fmt::format("{}: its face colors are not read; vertex colors would be", file.string()));
}

/// Whitens the gray material that assimp assigns to a mesh without one, so that vertex colors show
/// unchanged.
void whiten_default_material(const MeshFormat& format, Scene& scene) {
  if (scene.colors.empty() && scene.light.empty()) return;
  for (Material& material : scene.materials)
    if (material.texture.empty() && (format.ply || material.name == AI_DEFAULT_MATERIAL_NAME))
      material.base_color = {255, 255, 255};
}

/// Converts a PLY to a scene with the objects that the PLY states.
Scene scene_of(PlyMesh mesh, const fs::path& file, std::vector<std::string>* warnings) {
  Scene scene;
  scene.name = file.stem().string();
  scene.positions_m = std::move(mesh.positions_m);
  scene.colors = std::move(mesh.colors);
  scene.triangles = std::move(mesh.triangles);
  const std::size_t faces = scene.triangles.size();
  scene.material_of.assign(faces, 0);
  scene.class_of.assign(faces, kVoid);
  scene.instance_of.assign(faces, 0);
  scene.materials.push_back({.name = "vertex colors", .texture = {}});
  if (!is_there(labels_path(file))) label_ply(scene, mesh, file, warnings);
  return scene;
}

/// Final steps common to all kinds of files.
Scene finished(Scene scene, const fs::path& file) {
  if (scene.triangles.empty())
    throw InputError(fmt::format("{}: has no visible faces", file.string()));
  if (format_of(file).ply && is_there(labels_path(file))) load_labels(scene, labels_path(file));
  find_boxes(scene);
  if (scene.rooms.empty()) rooms_from_floors(scene);
  validate(scene);
  return scene;
}

/// Loads a mesh through assimp.
Scene load_foreign(const fs::path& file, const MeshFormat& format, const LabelRules& rules,
                   const MeshUse& use, std::vector<std::string>* warnings) {
  Assimp::Importer importer;
  MtlTextures textures;
  const aiScene& in = read(importer, file, use, textures, warnings);
  if (warnings != nullptr) std::ranges::move(textures.warnings, std::back_inserter(*warnings));
  if (format.obj) warn_of_missing_materials(file, warnings);
  Scene scene;
  scene.name = file.stem().string();
  ImageStore own_images;
  MaterialsIn materials = convert_materials(
      in, file, format.gltf, use.images == nullptr ? own_images : *use.images, warnings);
  scene.materials = std::move(materials.materials);
  LabelRules all_rules = rules;
  const LabelRules beside = find_label_rules(file);
  all_rules.rules.insert(all_rules.rules.end(), beside.rules.begin(), beside.rules.end());
  gather({.scene = in, .file = file, .format = format, .rules = all_rules, .uvs = textures.uvs},
         scene);
  whiten_default_material(format, scene);
  spread_glow(scene, materials.glow);
  if (warnings != nullptr) warn_of_edges(scene, materials.edges, file, *warnings);
  if (scene.uvs.empty())
    for (Material& material : scene.materials) material.texture = {};
  return finished(std::move(scene), file);
}

}  // namespace

Scene load_mesh(const fs::path& file, std::vector<std::string>* warnings, const LabelRules& rules,
                const MeshUse& use) {
  const MeshFormat format = format_of(file);
  if (format.ply) {
    const HeldBytes held = map_file(file);
    warn_of_face_colors(held.view, file, warnings);
    if (is_plain_ply(held.view)) {
      PlyMesh mesh = parse_ply(held.view, file.string());
      warn_of_bytes_left(mesh, file, warnings);
      return finished(scene_of(std::move(mesh), file, warnings), file);
    }
  }
  return load_guarded(file, warnings, [&](std::vector<std::string>* reported) {
    return load_foreign(file, format, rules, use, reported);
  });
}

Scene load_turned_mesh(const fs::path& file, std::optional<UpAxis> up,
                       std::vector<std::string>* warnings, const LabelRules& rules,
                       const MeshUse& use) {
  Scene scene = load_mesh(file, warnings, rules, use);
  const bool turned = format_of(file).y_up;
  if (up && (*up == UpAxis::kY) != turned) turn_y_up(scene, turned);
  if (!up && !turned && warnings != nullptr && looks_y_up(scene))
    warnings->push_back(
        fmt::format("{}: looks as if y were up: try up: y (--up y)", file.string()));
  return scene;
}

}  // namespace mh
