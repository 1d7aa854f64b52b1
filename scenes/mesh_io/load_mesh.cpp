// SPDX-License-Identifier: Apache-2.0
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "scenes/floor.hpp"
#include "scenes/guard.hpp"
#include "scenes/mesh_io/collada.hpp"
#include "scenes/mesh_io/glow.hpp"
#include "scenes/mesh_io/gltf.hpp"
#include "scenes/mesh_io/instances_in.hpp"
#include "scenes/mesh_io/label_rules.hpp"
#include "scenes/mesh_io/labels_file.hpp"
#include "scenes/mesh_io/large_faces.hpp"
#include "scenes/mesh_io/materials_in.hpp"
#include "scenes/mesh_io/mesh_io.hpp"
#include "scenes/mesh_io/node_name.hpp"
#include "scenes/mesh_io/noted_files.hpp"
#include "scenes/mesh_io/ply.hpp"
#include "scenes/mesh_io/ply_labels.hpp"
#include "scenes/srgb.hpp"
#include "slam/core/error.hpp"
#include "slam/core/file_errors.hpp"
#include "slam/core/files.hpp"
#include "slam/core/held_bytes.hpp"
#include "slam/core/lower_case.hpp"
#include "slam/core/narrowed.hpp"
#include "slam/core/text_file.hpp"

namespace mh {
namespace fs = std::filesystem;

namespace {

/// Properties of a file format.
struct Format {
  bool ply = false, gltf = false, obj = false, dae = false, y_up = false;
};

Format format_of(const fs::path& file) {
  const std::string ending = lower_case(file.extension().string());
  const bool gltf = ending == ".glb" || ending == ".gltf";
  return {.ply = ending == ".ply",
          .gltf = gltf,
          .obj = ending == ".obj",
          .dae = ending == ".dae",
          .y_up = gltf || ending == ".dae"};
}

/// A number in a glTF node's extras; nullopt if there is none that To can represent.
template <class To>
std::optional<To> extra_number(const aiMetadata& extras, const char* key) {
  double number = 0;
  std::uint64_t unsigned_number = 0;
  std::int32_t integer = 0;
  if (extras.Get(key, number)) return narrowed<To>(number);
  if (extras.Get(key, unsigned_number)) return narrowed<To>(unsigned_number);
  if (extras.Get(key, integer)) return narrowed<To>(integer);
  return std::nullopt;
}

/// The class in a glTF node's extras, by name or by number.
std::optional<ClassId> extra_class(const aiMetadata& extras) {
  aiString name;
  if (extras.Get("class", name)) return class_by_name(name.C_Str());
  const auto id = extra_number<ClassId>(extras, "class");
  return id && *id < classes().size() ? id : std::nullopt;
}

/// The label of a node: its extras first, then its name.
NodeLabel label_of(const aiNode& node) {
  NodeLabel label = parse_node_name(node.mName.C_Str());
  if (node.mMetaData == nullptr) return label;
  if (const auto id = extra_class(*node.mMetaData)) {
    label.class_id = *id;
    label.is_explicit = true;
  }
  if (const auto id = extra_number<InstanceId>(*node.mMetaData, "instance")) label.instance = *id;
  return label;
}

/// Guesses the class from names around a node if its own gives none: the mesh's, then those of the
/// nodes above, the nearest first, except "floor", which is used for stories. The top node is
/// skipped: it is named after the exporter or the file.
ClassId guess_around(const aiNode& node, const aiMesh& mesh) {
  ClassId found = guess_class(mesh.mName.C_Str());
  for (const aiNode* above = node.mParent; found == kVoid && above != nullptr && above->mParent;
       above = above->mParent)
    if (const ClassId id = label_of(*above).class_id; id != class_by_name("floor")) found = id;
  return found;
}

/// Traverses the nodes of a file and collects their meshes into one scene.
class Gatherer {
 public:
  Gatherer(const aiScene& in, const fs::path& file, const Format& format, const LabelRules& rules,
           Scene& scene)
      : in_(in), file_(file), format_(format), rules_(rules), scene_(scene) {}

  void run() {
    constexpr unsigned kMostMaterials = 1U << 16;  // material_of has 16 bits
    if (in_.mNumMaterials > kMostMaterials)
      throw InputError(fmt::format("{}: {} materials are more than {}", file_.string(),
                                   in_.mNumMaterials, kMostMaterials));
    survey(*in_.mRootNode);
    reserve_ids(*in_.mRootNode);
    visit(*in_.mRootNode, aiMatrix4x4());
    // Per-vertex arrays are all or nothing: parts without them were filled with neutral values.
    if (!any_uvs_) scene_.uvs.clear();
    if (!any_colors_) scene_.colors.clear();
    if (!any_light_) scene_.light.clear();
    std::ranges::sort(scene_.instances, {}, &Instance::id);
  }

 private:
  /// Whether save_glb wrote the file: then vertex colors are light.
  void survey(const aiNode& node) {
    ours_ = ours_ || (format_.gltf && std::string_view(node.mName.C_Str()).find("#instance=") !=
                                          std::string_view::npos);
    for (unsigned i = 0; i < node.mNumChildren; ++i) survey(*node.mChildren[i]);
  }

  /// Reserves the ids that the file states; the other objects get free ones.
  void reserve_ids(const aiNode& node) {
    if (const auto id = label_of(node).instance) reserved_.insert(*id);
    for (unsigned i = 0; i < node.mNumChildren; ++i) reserve_ids(*node.mChildren[i]);
  }

  void visit(const aiNode& node, const aiMatrix4x4& world_from_parent) {
    const aiMatrix4x4 world_from_node = world_from_parent * node.mTransformation;
    // A node is an object; if rules label its pieces differently, each class is a separate one.
    std::map<ClassId, InstanceId> instance_of;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const aiMesh& mesh = *in_.mMeshes[node.mMeshes[i]];
      NodeLabel label = label_of(node);
      if (!label.is_explicit && label.class_id == kVoid) label.class_id = guess_around(node, mesh);
      if (const auto reported = rules_.find({label.name, mesh.mName.C_Str(), material_name(mesh)}))
        label.class_id = *reported;
      const auto [place, is_new] = instance_of.try_emplace(label.class_id, InstanceId{0});
      if (is_new) place->second = enter_instance(label);
      add(mesh, world_from_node, label.class_id, place->second);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i], world_from_node);
  }

  std::string material_name(const aiMesh& mesh) const {
    return in_.mMaterials[mesh.mMaterialIndex]->GetName().C_Str();
  }

  InstanceId free_id() {
    while (reserved_.contains(next_id_)) {
      if (next_id_ == 65535)
        throw InputError(fmt::format("{}: more than 65535 objects", file_.string()));
      ++next_id_;
    }
    reserved_.insert(next_id_);
    return next_id_;
  }

  /// The id for a node's faces; a PLY is one unlabeled piece.
  InstanceId enter_instance(const NodeLabel& label) {
    if (format_.ply) return 0;
    if (label.instance == InstanceId{0}) return 0;
    const InstanceId id = label.instance ? *label.instance : free_id();
    if (!entered_.insert(id).second) return id;
    scene_.instances.push_back(
        {.id = id, .class_id = label.class_id, .name = unique_name(label.name)});
    return id;
  }

  std::string unique_name(const std::string& wanted) {
    const std::string base = wanted.empty() ? "object" : wanted;
    std::string name = base;
    // Continues from the last copy: some files have thousands of nodes with one name.
    for (int& copies = copies_of_.try_emplace(base, 1).first->second; !names_.insert(name).second;)
      name = fmt::format("{}_{}", base, ++copies);
    return name;
  }

  void add(const aiMesh& mesh, const aiMatrix4x4& world_from_node, ClassId class_id,
           InstanceId instance) {
    const auto first = static_cast<std::uint32_t>(scene_.positions_m.size());
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) add_vertex(mesh, i, world_from_node);
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices != 3) continue;  // points and lines are invisible
      std::array<std::uint32_t, 3> triangle;
      for (int corner = 0; corner < 3; ++corner) {
        if (face.mIndices[corner] >= mesh.mNumVertices)
          throw InputError(fmt::format("{}: face {} names vertex {} of {}", file_.string(), i,
                                       face.mIndices[corner], mesh.mNumVertices));
        triangle[corner] = first + face.mIndices[corner];
      }
      scene_.triangles.push_back(triangle);
      scene_.material_of.push_back(static_cast<std::uint16_t>(mesh.mMaterialIndex));
      scene_.class_of.push_back(class_id);
      scene_.instance_of.push_back(instance);
    }
  }

  void add_vertex(const aiMesh& mesh, unsigned i, const aiMatrix4x4& world_from_node) {
    const aiVector3D p = world_from_node * mesh.mVertices[i];
    const Eigen::Vector3f position =
        format_.y_up ? Eigen::Vector3f(p.x, -p.z, p.y) : Eigen::Vector3f(p.x, p.y, p.z);
    if (!position.allFinite())
      throw InputError(fmt::format("{}: vertex {} has a position that is not finite",
                                   file_.string(), scene_.positions_m.size()));
    scene_.positions_m.push_back(position);

    Eigen::Vector2f uv = Eigen::Vector2f::Zero();
    if (mesh.HasTextureCoords(0)) {
      any_uvs_ = true;
      uv = {mesh.mTextureCoords[0][i].x, 1.0F - mesh.mTextureCoords[0][i].y};
      if (!uv.allFinite()) uv.setZero();
    }
    scene_.uvs.push_back(uv);

    Eigen::Vector3f color = Eigen::Vector3f::Ones();
    if (mesh.HasVertexColors(0)) {
      (ours_ ? any_light_ : any_colors_) = true;
      const aiColor4D& c = mesh.mColors[0][i];
      color = Eigen::Vector3f(c.r, c.g, c.b).cwiseMax(0.0F);
    }
    scene_.light.push_back(ours_ ? color : Eigen::Vector3f::Ones().eval());
    scene_.colors.push_back(ours_ ? Rgb8{255, 255, 255} : srgb_color(color));
  }

  Rgb8 srgb_color(const Eigen::Vector3f& color) const {
    if (format_.gltf) return srgb_from_linear(color);
    const Eigen::Vector3f level = 255.0F * color.cwiseMin(1.0F) + Eigen::Vector3f::Constant(0.5F);
    return {static_cast<std::uint8_t>(level.x()), static_cast<std::uint8_t>(level.y()),
            static_cast<std::uint8_t>(level.z())};
  }

  const aiScene& in_;
  const fs::path& file_;
  const Format& format_;
  const LabelRules& rules_;
  Scene& scene_;
  std::set<InstanceId> reserved_{0}, entered_;
  std::set<std::string> names_;
  std::map<std::string, int> copies_of_;
  InstanceId next_id_ = 1;
  bool ours_ = false, any_uvs_ = false, any_colors_ = false, any_light_ = false;
};

const aiScene& read(Assimp::Importer& importer, const fs::path& file, const Format& format,
                    const MeshUse& use, std::vector<std::string>* warnings) {
  require_readable(file);
  if (format.obj) without_mark(map_file(file).view, file);  // throws on UTF-16
  std::optional<std::string> repaired;
  if (format.gltf) repaired = repaired_gltf(map_file(file).view, file);
  // The importer takes ownership.
  importer.SetIOHandler(repaired ? new NotedFiles(file, std::move(*repaired)) : new NotedFiles);
  // No step that reorders vertices or faces: labels next to a PLY depend on their order.
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

/// assimp looks for an OBJ's materials in the file that mtllib names, then in one named like the
/// OBJ, and silently continues without them.
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
    if (!is_there(file.parent_path() / rest))
      warnings->push_back(fmt::format("{}:{}: mtllib {} is missing: what it colors is gray",
                                      file.string(),
                                      1 + std::ranges::count(held.view.substr(0, at), '\n'), rest));
  }
}

/// assimp assigns a gray material to a mesh without one; vertex colors should show unchanged.
void whiten_default_material(const Format& format, Scene& scene) {
  if (scene.colors.empty() && scene.light.empty()) return;
  for (Material& material : scene.materials)
    if (material.texture.empty() && (format.ply || material.name == AI_DEFAULT_MATERIAL_NAME))
      material.base_color = {255, 255, 255};
}

/// A PLY as a scene with the objects that the PLY states.
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
    throw InputError(fmt::format("{}: has no faces to be seen", file.string()));
  if (format_of(file).ply && is_there(labels_path(file))) load_labels(scene, labels_path(file));
  find_boxes(scene);
  if (scene.rooms.empty()) rooms_from_floors(scene);
  validate(scene);
  return scene;
}

/// Through assimp.
Scene load_foreign(const fs::path& file, const Format& format, const LabelRules& rules,
                   const MeshUse& use, std::vector<std::string>* warnings) {
  Assimp::Importer importer;
  const aiScene& in = read(importer, file, format, use, warnings);
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
  Gatherer(in, file, format, all_rules, scene).run();
  whiten_default_material(format, scene);
  spread_glow(scene, materials.glow);
  if (scene.uvs.empty())
    for (Material& material : scene.materials) material.texture = {};
  return finished(std::move(scene), file);
}

}  // namespace

Scene load_mesh(const fs::path& file, std::vector<std::string>* warnings, const LabelRules& rules,
                const MeshUse& use) {
  const Format format = format_of(file);
  if (format.ply) {
    const HeldBytes held = map_file(file);
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
