// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/emissive_strength.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "slam/core/files.hpp"
#include "slam/core/json_text.hpp"

namespace mh {
namespace {

using Json = nlohmann::json;

constexpr const char* kExtension = "KHR_materials_emissive_strength";

/// The JSON of a .gltf, or of a .glb's first chunk.
std::string gltf_json(const std::filesystem::path& file) {
  std::string bytes = read_file(file);
  if (!bytes.starts_with("glTF") || bytes.size() < 20) return bytes;
  std::uint32_t size = 0;
  std::memcpy(&size, bytes.data() + 12, sizeof size);
  return bytes.substr(20, size);
}

/// Traverses a file in assimp's order.
class MaterialOrder {
 public:
  explicit MaterialOrder(const Json& gltf) : gltf_(gltf) {
    const std::size_t scene = gltf.value("scene", std::size_t{0});
    for (const Json& node : gltf.at("scenes").at(scene).value("nodes", Json::array()))
      visit_node(node.get<std::size_t>());
  }
  /// Material indices as in the file.
  const std::vector<std::size_t>& materials() const { return materials_; }

 private:
  void visit_node(std::size_t index) {
    if (!nodes_.insert(index).second) return;
    const Json& node = gltf_.at("nodes").at(index);
    if (node.contains("children"))
      for (const Json& child : node.at("children")) visit_node(child.get<std::size_t>());
    if (!node.contains("mesh")) return;
    for (const Json& part :
         gltf_.at("meshes").at(node.at("mesh").get<std::size_t>()).at("primitives"))
      if (part.contains("material")) {
        const auto material = part.at("material").get<std::size_t>();
        if (seen_.insert(material).second) materials_.push_back(material);
      }
  }

  const Json& gltf_;
  std::set<std::size_t> nodes_, seen_;
  std::vector<std::size_t> materials_;
};

float strength_of(const Json& material) {
  const Json::json_pointer place(std::string("/extensions/") + kExtension + "/emissiveStrength");
  if (!material.contains(place) || !material.at(place).is_number()) return 1.0F;
  return std::clamp(material.at(place).get<float>(), 0.0F, 1e6F);
}

}  // namespace

std::vector<float> emissive_strengths(const std::filesystem::path& file) {
  std::vector<float> strengths;
  const std::string text = gltf_json(file);
  if (text.find(kExtension) == text.npos) return strengths;
  try {
    const Json gltf = parse_json_or_discard<Json>(text);
    const MaterialOrder order(gltf);
    for (const std::size_t material : order.materials())
      strengths.push_back(strength_of(gltf.at("materials").at(material)));
  } catch (const Json::exception&) {
    return {};  // assimp, which has already read it, reports what is wrong with it
  }
  return strengths;
}

}  // namespace mh
