// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/large_faces.hpp"

#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace mh {
namespace {

constexpr unsigned kMostCorners = 2000;

bool is_large(const aiFace& face) {
  return face.mNumIndices > kMostCorners;
}

/// Moves a face into an empty one; assimp's own assignment copies.
void move_face(aiFace& from, aiFace& to) {
  std::swap(from.mNumIndices, to.mNumIndices);
  std::swap(from.mIndices, to.mIndices);
}

/// Gives a mesh a new array of faces, in which large faces are cut into triangles.
void cut(aiMesh& mesh) {
  const std::span old_faces(mesh.mFaces, mesh.mNumFaces);
  std::size_t count = 0;
  for (const aiFace& face : old_faces) count += is_large(face) ? face.mNumIndices - 2 : 1;
  auto* faces = new aiFace[count];
  aiFace* next = faces;
  for (aiFace& face : old_faces) {
    if (!is_large(face)) {
      move_face(face, *next++);
      continue;
    }
    for (unsigned k = 2; k < face.mNumIndices; ++k, ++next) {
      next->mIndices = new unsigned[3]{face.mIndices[0], face.mIndices[k - 1], face.mIndices[k]};
      next->mNumIndices = 3;
    }
  }
  delete[] mesh.mFaces;
  mesh.mFaces = faces;
  mesh.mNumFaces = static_cast<unsigned>(count);
  // assimp asserts that a mesh with the polygon flag has polygons, so the flag is cleared if none
  // is left.
  const auto is_polygon = [](const aiFace& face) { return face.mNumIndices > 3; };
  mesh.mPrimitiveTypes |= aiPrimitiveType_TRIANGLE;
  if (std::ranges::none_of(std::span(faces, count), is_polygon))
    mesh.mPrimitiveTypes &= ~static_cast<unsigned>(aiPrimitiveType_POLYGON);
}

}  // namespace

void cut_large_faces(const aiScene& in, const std::filesystem::path& file,
                     std::vector<std::string>* warnings) {
  for (aiMesh* mesh : std::span(in.mMeshes, in.mNumMeshes)) {
    const std::span faces(mesh->mFaces, mesh->mNumFaces);
    const auto large = std::ranges::find_if(faces, is_large);
    if (large == faces.end()) continue;
    if (warnings != nullptr)
      warnings->push_back(
          fmt::format("{}: mesh '{}' has a face of {} corners: it is cut into a fan of triangles, "
                      "which is wrong where it is not convex",
                      file.string(), mesh->mName.C_Str(), large->mNumIndices));
    cut(*mesh);
  }
}

}  // namespace mh
