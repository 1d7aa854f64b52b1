// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/materials_in.hpp"

#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "scenes/srgb.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"

namespace mh {
namespace fs = std::filesystem;

namespace {

constexpr Rgb8 kMissing{255, 0, 255};  // seen at once, and in no real room

/// The picture in these bytes; empty if they hold none.
Grid2d<Rgb8> decode(const void* data, std::size_t size) {
  if (size == 0) return {};
  const cv::Mat bytes(1, static_cast<int>(size), CV_8UC1, const_cast<void*>(data));
  const cv::Mat bgr = cv::imdecode(bytes, cv::IMREAD_COLOR);
  if (bgr.empty()) return {};
  Grid2d<Rgb8> picture(bgr.cols, bgr.rows);
  cv::Mat rgb(bgr.rows, bgr.cols, CV_8UC3, picture.data());
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  return picture;
}

Grid2d<Rgb8> convert_embedded(const aiTexture& texture) {
  if (texture.mHeight == 0) return decode(texture.pcData, texture.mWidth);
  Grid2d<Rgb8> picture(static_cast<int>(texture.mWidth), static_cast<int>(texture.mHeight));
  std::transform(texture.pcData, texture.pcData + picture.size(), picture.begin(),
                 [](const aiTexel& t) {
                   return Rgb8{t.r, t.g, t.b};
                 });
  return picture;
}

Grid2d<Rgb8> read_picture(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {};
  const std::string bytes = read_file(path);
  return decode(bytes.data(), bytes.size());
}

Grid2d<Rgb8> find_texture(const aiScene& in, const std::string& name, const fs::path& folder) {
  if (const aiTexture* embedded = in.GetEmbeddedTexture(name.c_str()))
    return convert_embedded(*embedded);
  std::string portable = name;
  std::ranges::replace(portable, '\\', '/');
  return read_picture(folder / portable);
}

Rgb8 convert_colour(const aiColor4D& c, bool linear) {
  if (linear) return srgb_from_linear(Eigen::Vector3f(c.r, c.g, c.b));
  const auto level = [](float v) {
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(v, 0.0F, 1.0F)));
  };
  return {level(c.r), level(c.g), level(c.b)};
}

Material convert(const aiScene& in, const aiMaterial& record, const fs::path& file, bool linear,
                 std::vector<std::string>* warnings) {
  Material material;
  material.name = record.GetName().C_Str();
  aiColor4D base(1.0F, 1.0F, 1.0F, 1.0F);
  if (record.Get(AI_MATKEY_BASE_COLOR, base) == aiReturn_SUCCESS ||
      record.Get(AI_MATKEY_COLOR_DIFFUSE, base) == aiReturn_SUCCESS)
    material.base_colour = convert_colour(base, linear);
  aiColor3D emission;
  if (record.Get(AI_MATKEY_COLOR_EMISSIVE, emission) == aiReturn_SUCCESS)
    material.emission = {std::max(0.0F, emission.r), std::max(0.0F, emission.g),
                         std::max(0.0F, emission.b)};
  aiString texture;
  if (record.GetTexture(aiTextureType_BASE_COLOR, 0, &texture) != aiReturn_SUCCESS &&
      record.GetTexture(aiTextureType_DIFFUSE, 0, &texture) != aiReturn_SUCCESS)
    return material;
  material.texture = find_texture(in, texture.C_Str(), file.parent_path());
  if (material.texture.empty()) {
    material.base_colour = kMissing;
    if (warnings)
      warnings->push_back(fmt::format("{}: material {}: texture {} is missing or no picture",
                                      file.string(), material.name, texture.C_Str()));
  }
  return material;
}

}  // namespace

std::vector<Material> convert_materials(const aiScene& in, const fs::path& file,
                                        bool linear_colours, std::vector<std::string>* warnings) {
  std::vector<Material> materials;
  for (unsigned i = 0; i < in.mNumMaterials; ++i)
    materials.push_back(convert(in, *in.mMaterials[i], file, linear_colours, warnings));
  return materials;
}

}  // namespace mh
