// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "scenes/mesh_io/mesh_io.hpp"
#include "scenes/mesh_io/node_name.hpp"
#include "scenes/srgb.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace fs = std::filesystem;

namespace {

static_assert(std::endian::native == std::endian::little,
              "buffers are written as they lie in memory");

using Json = nlohmann::json;

// Constants from the glTF 2.0 specification.
constexpr int kFloat = 5126, kUint32 = 5125;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr int kRepeat = 10497;

/// Faces of one node: those with this instance and class, by material.
struct NodeKey {
  InstanceId instance;
  ClassId class_id;
  friend auto operator<=>(const NodeKey&, const NodeKey&) = default;
};
using FacesByMaterial = std::map<std::uint16_t, std::vector<std::size_t>>;

Eigen::Vector3f y_up(const Eigen::Vector3f& p) {
  return {p.x(), p.z(), -p.y()};
}

Eigen::Vector3f vertex_factor(const Scene& scene, std::uint32_t vertex) {
  Eigen::Array3f factor = Eigen::Array3f::Ones();
  if (!scene.light.empty()) factor *= scene.light[vertex].array();
  if (!scene.colors.empty()) factor *= linear_from_srgb(scene.colors[vertex]).array();
  return factor.matrix();
}

Json list_of(const Eigen::Vector3f& v) {
  return {v.x(), v.y(), v.z()};
}

/// The texture as a PNG, with the material's opacity, if any, as its fourth channel.
std::vector<unsigned char> png_of(const Material& material) {
  const Grid2d<Rgb8>& texture = material.texture;
  const cv::Mat rgb(texture.height(), texture.width(), CV_8UC3, const_cast<Rgb8*>(texture.data()));
  cv::Mat out;
  cv::cvtColor(rgb, out, cv::COLOR_RGB2BGR);
  if (!material.opacity.empty()) {
    const cv::Mat opacity(texture.height(), texture.width(), CV_8UC1,
                          const_cast<std::uint8_t*>(material.opacity.data()));
    cv::Mat with_opacity;
    cv::merge(std::vector<cv::Mat>{out, opacity}, with_opacity);  // B, G, R, A
    out = with_opacity;
  }
  std::vector<unsigned char> png;
  cv::imencode(".png", out, png, {cv::IMWRITE_PNG_COMPRESSION, 3});
  return png;
}

/// Collects the JSON and the binary chunk of one file.
class GlbBuilder {
 public:
  explicit GlbBuilder(const Scene& scene)
      : scene_(scene), own_index_(scene.positions_m.size()), seen_in_(scene.positions_m.size()) {
    for (const char* part : {"accessors", "bufferViews", "meshes", "nodes", "materials"})
      json_[part] = Json::array();
  }

  std::string build() {
    json_["asset"] = {{"version", "2.0"}, {"generator", "Modelhouse"}};
    for (const Material& material : scene_.materials) add_material(material);
    add_nodes();
    json_["scene"] = 0;
    json_["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
    std::vector<std::string> used = {"KHR_materials_unlit"};
    if (strong_emission_) used.emplace_back("KHR_materials_emissive_strength");
    if (has_panes_) used.emplace_back("KHR_materials_transmission");
    json_["extensionsUsed"] = used;
    return chunks();
  }

 private:
  /// @returns the index of the view
  std::size_t add_view(const void* data, std::size_t size, int target) {
    binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
    Json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", size}};
    if (target != 0) view["target"] = target;
    binary_.append(static_cast<const char*>(data), size);
    json_["bufferViews"].push_back(std::move(view));
    return json_["bufferViews"].size() - 1;
  }

  template <class Item>
  std::size_t add_accessor(const std::vector<Item>& items, const char* type) {
    constexpr bool kIndices = std::is_same_v<Item, std::uint32_t>;
    const std::size_t view = add_view(items.data(), items.size() * sizeof(Item),
                                      kIndices ? kElementArrayBuffer : kArrayBuffer);
    json_["accessors"].push_back({{"bufferView", view},
                                  {"componentType", kIndices ? kUint32 : kFloat},
                                  {"count", items.size()},
                                  {"type", type}});
    return json_["accessors"].size() - 1;
  }

  void add_material(const Material& material) {
    // A pane's color is its transmission.
    const Eigen::Vector3f base =
        material.is_pane() ? material.transmission : linear_from_srgb(material.base_color);
    Json surface = {{"baseColorFactor", {base.x(), base.y(), base.z(), 1.0F}},
                    {"metallicFactor", 0.0},
                    {"roughnessFactor", 1.0}};
    if (!material.texture.empty()) surface["baseColorTexture"] = {{"index", add_texture(material)}};
    Json record = {{"name", material.name},
                   {"pbrMetallicRoughness", std::move(surface)},
                   {"doubleSided", true}};
    const float strength = material.emission.maxCoeff();
    // In glTF an emissive material cannot be unlit.
    if (!(strength > 0.0F)) record["extensions"]["KHR_materials_unlit"] = Json::object();
    if (material.is_pane()) {
      record["extensions"].erase("KHR_materials_unlit");
      record["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 1.0}};
      has_panes_ = true;
    }
    if (!material.opacity.empty()) {
      record["alphaMode"] = "MASK";
      record["alphaCutoff"] = kOpaqueFrom / 255.0;
    }
    if (strength > 0.0F) {  // factors are at most 1
      const float unit = std::max(strength, 1.0F);
      record["emissiveFactor"] = list_of(material.emission / unit);
      if (unit > 1.0F) {
        record["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", unit}};
        strong_emission_ = true;
      }
    }
    json_["materials"].push_back(std::move(record));
  }

  std::size_t add_texture(const Material& material) {
    if (!json_.contains("textures")) {
      json_["textures"] = Json::array();
      json_["images"] = Json::array();
      json_["samplers"] = Json::array({{{"wrapS", kRepeat}, {"wrapT", kRepeat}}});
    }
    const std::vector<unsigned char> png = png_of(material);
    json_["images"].push_back({{"name", material.name},
                               {"mimeType", "image/png"},
                               {"bufferView", add_view(png.data(), png.size(), 0)}});
    json_["textures"].push_back({{"sampler", 0}, {"source", json_["images"].size() - 1}});
    return json_["textures"].size() - 1;
  }

  void add_nodes() {
    std::map<InstanceId, std::string> names{{0, "unlabeled"}};
    for (const Instance& instance : scene_.instances) names[instance.id] = instance.name;
    std::map<NodeKey, FacesByMaterial> nodes;
    for (std::size_t i = 0; i < scene_.triangles.size(); ++i)
      nodes[{scene_.instance_of[i], scene_.class_of[i]}][scene_.material_of[i]].push_back(i);
    Json children = Json::array();
    for (const auto& [key, faces_by_material] : nodes) {
      Json primitives = Json::array();
      for (const auto& [material, faces] : faces_by_material)
        primitives.push_back(make_primitive(faces, material));
      json_["meshes"].push_back(
          {{"name", names.at(key.instance)}, {"primitives", std::move(primitives)}});
      children.push_back(json_["nodes"].size());
      json_["nodes"].push_back(
          {{"name", node_name(names.at(key.instance), key.class_id, key.instance)},
           {"mesh", json_["meshes"].size() - 1},
           {"extras",
            {{"class", std::string(classes()[key.class_id].name)},
             {"instance", int{key.instance}}}}});
    }
    json_["scenes"] = Json::array({{{"name", scene_.name}, {"nodes", std::move(children)}}});
  }

  /// A primitive of these faces, with vertices of its own in the order in which the faces first use
  /// them.
  Json make_primitive(const std::vector<std::size_t>& faces, std::uint16_t material) {
    ++primitive_;
    std::vector<std::uint32_t> vertices, indices;
    indices.reserve(3 * faces.size());
    for (const std::size_t face : faces)
      for (const std::uint32_t vertex : scene_.triangles[face]) {
        if (seen_in_[vertex] != primitive_) {
          seen_in_[vertex] = primitive_;
          own_index_[vertex] = static_cast<std::uint32_t>(vertices.size());
          vertices.push_back(vertex);
        }
        indices.push_back(own_index_[vertex]);
      }
    std::vector<Eigen::Vector3f> positions, factors;
    Eigen::Vector3f low = Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity());
    Eigen::Vector3f high = -low;
    for (const std::uint32_t vertex : vertices) {
      positions.push_back(y_up(scene_.positions_m[vertex]));
      factors.push_back(vertex_factor(scene_, vertex));
      low = low.cwiseMin(positions.back());
      high = high.cwiseMax(positions.back());
    }
    Json attributes;
    const std::size_t position = add_accessor(positions, "VEC3");
    json_["accessors"][position]["min"] = list_of(low);
    json_["accessors"][position]["max"] = list_of(high);
    attributes["POSITION"] = position;
    attributes["COLOR_0"] = add_accessor(factors, "VEC3");
    if (!scene_.uvs.empty()) {
      std::vector<Eigen::Vector2f> uvs;
      for (const std::uint32_t vertex : vertices) uvs.push_back(scene_.uvs[vertex]);
      attributes["TEXCOORD_0"] = add_accessor(uvs, "VEC2");
    }
    return {{"attributes", std::move(attributes)},
            {"indices", add_accessor(indices, "SCALAR")},
            {"material", material}};
  }

  /// The file: a header of 12 bytes, then the JSON chunk and the binary chunk.
  std::string chunks() {
    std::string text = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
    const std::uint64_t size = 12 + 8 + text.size() + 8 + binary_.size();
    if (size > std::numeric_limits<std::uint32_t>::max())
      throw InputError(
          fmt::format("scene {}: is too large for a GLB file, which can hold 4 GiB", scene_.name));
    std::string file;
    file.reserve(static_cast<std::size_t>(size));
    const auto number = [&](std::uint64_t value) {
      const auto word = static_cast<std::uint32_t>(value);
      file.append(reinterpret_cast<const char*>(&word), sizeof word);
    };
    file += "glTF";
    number(2);
    number(size);
    number(text.size());
    file += "JSON" + text;
    number(binary_.size());
    file += std::string_view("BIN\0", 4);
    return file + binary_;
  }

  const Scene& scene_;
  Json json_;
  std::string binary_;
  std::vector<std::uint32_t> own_index_, seen_in_;  ///< by vertex: index in its last primitive, and
                                                    ///< that primitive's number
  std::uint32_t primitive_ = 0;
  bool strong_emission_ = false, has_panes_ = false;
};

}  // namespace

void save_glb(const Scene& scene, const fs::path& file) {
  validate(scene);
  write_atomically(file, GlbBuilder(scene).build());
}

}  // namespace mh
