// SPDX-License-Identifier: Apache-2.0
#include <assimp/scene.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <assimp/Exporter.hpp>

#include <cstdio>
#include <map>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "scenes/mesh_io/mesh_io.hpp"
#include "scenes/mesh_io/node_name.hpp"
#include "scenes/srgb.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"

namespace mh {
namespace fs = std::filesystem;

namespace {

/// Faces of one node: those with this instance and class, by material.
struct NodeKey {
  InstanceId instance;
  ClassId class_id;
  friend auto operator<=>(const NodeKey&, const NodeKey&) = default;
};
using FacesByMaterial = std::map<std::uint16_t, std::vector<std::size_t>>;

aiVector3D y_up(const Eigen::Vector3f& p) {
  return {p.x(), p.z(), -p.y()};
}
aiColor4D colour4(const Eigen::Vector3f& c) {
  return {c.x(), c.y(), c.z(), 1.0F};
}

Eigen::Vector3f vertex_factor(const Scene& scene, std::uint32_t vertex) {
  Eigen::Array3f factor = Eigen::Array3f::Ones();
  if (!scene.light.empty()) factor *= scene.light[vertex].array();
  if (!scene.colours.empty()) factor *= linear_from_srgb(scene.colours[vertex]).array();
  return factor.matrix();
}

/// Normals of the scene's vertices, area-weighted over their faces. The exporter joins vertices
/// that differ in colour alone; normals keep the two sides of an edge, and so their light, apart.
std::vector<Eigen::Vector3f> vertex_normals(const Scene& scene) {
  std::vector<Eigen::Vector3f> normals(scene.positions_m.size(), Eigen::Vector3f::Zero());
  for (const auto& [a, b, c] : scene.triangles) {
    const Eigen::Vector3f ab = scene.positions_m[b] - scene.positions_m[a];
    const Eigen::Vector3f ac = scene.positions_m[c] - scene.positions_m[a];
    const Eigen::Vector3f doubled_area = ab.cross(ac);
    for (const std::uint32_t vertex : {a, b, c}) normals[vertex] += doubled_area;
  }
  for (Eigen::Vector3f& normal : normals)
    normal = normal.squaredNorm() > 0.0F ? normal.normalized() : Eigen::Vector3f::UnitZ().eval();
  return normals;
}

/// The faces as one mesh with its own vertices, in the order in which the faces first use them.
std::unique_ptr<aiMesh> make_mesh(const Scene& scene, const std::vector<Eigen::Vector3f>& normals,
                                  const std::vector<std::size_t>& faces, std::uint16_t material,
                                  const std::string& name) {
  std::map<std::uint32_t, unsigned> own_index;
  std::vector<std::uint32_t> vertices;
  auto mesh = std::make_unique<aiMesh>();
  mesh->mName = name;
  mesh->mMaterialIndex = material;
  mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  mesh->mNumFaces = static_cast<unsigned>(faces.size());
  mesh->mFaces = new aiFace[faces.size()];
  for (std::size_t i = 0; i < faces.size(); ++i) {
    aiFace& face = mesh->mFaces[i];
    face.mNumIndices = 3;
    face.mIndices = new unsigned[3];
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t vertex = scene.triangles[faces[i]][corner];
      const auto [entry, is_new] = own_index.try_emplace(vertex, vertices.size());
      if (is_new) vertices.push_back(vertex);
      face.mIndices[corner] = entry->second;
    }
  }
  mesh->mNumVertices = static_cast<unsigned>(vertices.size());
  mesh->mVertices = new aiVector3D[vertices.size()];
  mesh->mNormals = new aiVector3D[vertices.size()];
  mesh->mColors[0] = new aiColor4D[vertices.size()];
  const bool textured = !scene.uvs.empty();
  if (textured) {
    mesh->mTextureCoords[0] = new aiVector3D[vertices.size()];
    mesh->mNumUVComponents[0] = 2;
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    mesh->mVertices[i] = y_up(scene.positions_m[vertices[i]]);
    mesh->mNormals[i] = y_up(normals[vertices[i]]);
    mesh->mColors[0][i] = colour4(vertex_factor(scene, vertices[i]));
    if (textured) {
      const Eigen::Vector2f& uv = scene.uvs[vertices[i]];
      mesh->mTextureCoords[0][i] = {uv.x(), 1.0F - uv.y(), 0.0F};  // assimp counts v upwards
    }
  }
  return mesh;
}

std::unique_ptr<aiTexture> make_texture(const Grid2d<Rgb8>& texture) {
  const cv::Mat rgb(texture.height(), texture.width(), CV_8UC3, const_cast<Rgb8*>(texture.data()));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  std::vector<unsigned char> png;
  cv::imencode(".png", bgr, png, {cv::IMWRITE_PNG_COMPRESSION, 3});
  auto result = std::make_unique<aiTexture>();
  result->mWidth =
      static_cast<unsigned>(png.size());  // mHeight = 0: a compressed file of mWidth bytes
  result->mHeight = 0;
  std::snprintf(result->achFormatHint, sizeof result->achFormatHint, "png");
  result->pcData = new aiTexel[png.size() / sizeof(aiTexel) + 1];
  std::copy(png.begin(), png.end(), reinterpret_cast<unsigned char*>(result->pcData));
  return result;
}

std::unique_ptr<aiMaterial> make_material_record(const Material& material, int texture_index) {
  auto record = std::make_unique<aiMaterial>();
  const aiString name(material.name);
  record->AddProperty(&name, AI_MATKEY_NAME);
  const aiColor4D base = colour4(linear_from_srgb(material.base_colour));
  record->AddProperty(&base, 1, AI_MATKEY_BASE_COLOR);
  const aiColor3D emission(material.emission.x(), material.emission.y(), material.emission.z());
  record->AddProperty(&emission, 1, AI_MATKEY_COLOR_EMISSIVE);
  const int unlit = aiShadingMode_Unlit, both_sides = 1;
  record->AddProperty(&unlit, 1, AI_MATKEY_SHADING_MODEL);
  record->AddProperty(&both_sides, 1, AI_MATKEY_TWOSIDED);
  if (texture_index >= 0) {
    const aiString path(fmt::format("*{}", texture_index));
    record->AddProperty(&path, AI_MATKEY_TEXTURE(aiTextureType_BASE_COLOR, 0));
  }
  return record;
}

void add_materials(const Scene& scene, aiScene& out) {
  std::vector<aiTexture*> textures;
  out.mNumMaterials = static_cast<unsigned>(scene.materials.size());
  out.mMaterials = new aiMaterial*[scene.materials.size()];
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& material = scene.materials[i];
    const int index = material.texture.empty() ? -1 : static_cast<int>(textures.size());
    if (index >= 0) textures.push_back(make_texture(material.texture).release());
    out.mMaterials[i] = make_material_record(material, index).release();
  }
  out.mNumTextures = static_cast<unsigned>(textures.size());
  out.mTextures = new aiTexture*[textures.size()];
  std::ranges::copy(textures, out.mTextures);
}

void add_nodes(const Scene& scene, aiScene& out) {
  std::map<InstanceId, std::string> names{{0, "unlabelled"}};
  for (const Instance& instance : scene.instances) names[instance.id] = instance.name;
  std::map<NodeKey, FacesByMaterial> nodes;
  for (std::size_t i = 0; i < scene.triangles.size(); ++i)
    nodes[{scene.instance_of[i], scene.class_of[i]}][scene.material_of[i]].push_back(i);

  const std::vector<Eigen::Vector3f> normals = vertex_normals(scene);
  std::vector<aiMesh*> meshes;
  out.mRootNode = new aiNode("scene");
  out.mRootNode->mNumChildren = static_cast<unsigned>(nodes.size());
  out.mRootNode->mChildren = new aiNode*[nodes.size()];
  std::size_t next = 0;
  for (const auto& [key, faces_by_material] : nodes) {
    auto* node = new aiNode(node_name(names.at(key.instance), key.class_id, key.instance));
    node->mParent = out.mRootNode;
    out.mRootNode->mChildren[next++] = node;
    node->mNumMeshes = static_cast<unsigned>(faces_by_material.size());
    node->mMeshes = new unsigned[faces_by_material.size()];
    std::size_t slot = 0;
    for (const auto& [material, faces] : faces_by_material) {
      node->mMeshes[slot++] = static_cast<unsigned>(meshes.size());
      meshes.push_back(
          make_mesh(scene, normals, faces, material, names.at(key.instance)).release());
    }
  }
  out.mNumMeshes = static_cast<unsigned>(meshes.size());
  out.mMeshes = new aiMesh*[meshes.size()];
  std::ranges::copy(meshes, out.mMeshes);
}

}  // namespace

void save_glb(const Scene& scene, const fs::path& file) {
  validate(scene);
  aiScene out;  // owns everything that is added to it
  add_materials(scene, out);
  add_nodes(scene, out);
  write_atomically(file, [&](const fs::path& temporary) {
    Assimp::Exporter exporter;
    if (exporter.Export(&out, "glb2", temporary.string()) != aiReturn_SUCCESS)
      throw InputError(
          fmt::format("{}: cannot be written: {}", file.string(), exporter.GetErrorString()));
  });
}

}  // namespace mh
