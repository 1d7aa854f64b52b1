// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/gather.hpp"

#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "scenes/mesh_io/node_name.hpp"
#include "scenes/srgb.hpp"
#include "slam/io/error.hpp"
#include "slam/io/narrowed.hpp"

namespace mh {
namespace fs = std::filesystem;

namespace {

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

/// The class in a glTF node's extras, given by name or by number.
std::optional<ClassId> extra_class(const aiMetadata& extras) {
  aiString name;
  if (extras.Get("class", name)) return class_by_name(name.C_Str());
  const auto id = extra_number<ClassId>(extras, "class");
  return id && *id < classes().size() ? id : std::nullopt;
}

/// The label of a node: from its extras or, for what they do not state, from its name.
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

/// For a node whose own name gives no class, guesses it from other names: first from the mesh's
/// name, then from the names of the nodes above it, nearest first. "floor" is ignored in the nodes
/// above, because there it means a story of a building. The top node is skipped: it is named after
/// the exporter or the file.
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
  Gatherer(const ReadMesh& mesh, Scene& scene)
      : in_(mesh.scene),
        file_(mesh.file),
        format_(mesh.format),
        rules_(mesh.rules),
        uvs_(mesh.uvs),
        scene_(scene) {}

  void run() {
    constexpr unsigned kMostMaterials = 1U << 16;  // material_of has 16 bits
    if (in_.mNumMaterials > kMostMaterials)
      throw InputError(fmt::format("{}: {} materials are more than {}", file_.string(),
                                   in_.mNumMaterials, kMostMaterials));
    survey(*in_.mRootNode);
    reserve_ids(*in_.mRootNode);
    visit(*in_.mRootNode, aiMatrix4x4());
    // Parts without a per-vertex array were filled with neutral values; an array that no part has
    // is cleared.
    if (!any_uvs_) scene_.uvs.clear();
    if (!any_colors_) scene_.colors.clear();
    if (!any_light_) scene_.light.clear();
    std::ranges::sort(scene_.instances, {}, &Instance::id);
  }

 private:
  /// Finds out whether save_glb wrote the file: if so, its vertex colors are light.
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
    // A node is an object; if rules label its pieces differently, each class is a separate object.
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

  /// The instance id for a node's faces; 0 for a PLY, which is one unlabeled piece.
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
    // Continues from the number of the last copy: some files have thousands of nodes with the same
    // name.
    for (int& copies = copies_of_.try_emplace(base, 1).first->second; !names_.insert(name).second;)
      name = fmt::format("{}_{}", base, ++copies);
    return name;
  }

  void add(const aiMesh& mesh, const aiMatrix4x4& world_from_node, ClassId class_id,
           InstanceId instance) {
    const auto first = static_cast<std::uint32_t>(scene_.positions_m.size());
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) add_vertex(mesh, i, world_from_node);
    if (const auto placed = uvs_.find(material_name(mesh)); placed != uvs_.end())
      for (std::size_t i = first; i < scene_.uvs.size(); ++i)
        scene_.uvs[i] = placed->second.place(scene_.uvs[i]);
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
  const MeshFormat& format_;
  const LabelRules& rules_;
  const std::map<std::string, MtlUvs>& uvs_;
  Scene& scene_;
  std::set<InstanceId> reserved_{0}, entered_;
  std::set<std::string> names_;
  std::map<std::string, int> copies_of_;
  InstanceId next_id_ = 1;
  bool ours_ = false, any_uvs_ = false, any_colors_ = false, any_light_ = false;
};

}  // namespace

void gather(const ReadMesh& mesh, Scene& scene) {
  Gatherer(mesh, scene).run();
}

}  // namespace mh
