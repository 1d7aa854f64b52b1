// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/gltf/primitives.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace mh::gltf {
namespace {

class Repairer {
 public:
  Repairer(Data& data, const std::vector<UvPlacement>& placements,
           std::vector<std::string>& warnings)
      : data_(data), placements_(placements), warnings_(warnings) {}

  void repair(Json& primitive, Json& mesh) {
    if (!primitive.is_object() || !primitive.contains("attributes")) return;
    Json& attributes = primitive["attributes"];
    apply_targets(primitive, mesh, attributes);
    primitive.erase("targets");
    place_uvs(primitive, mesh, attributes);
    make_floats(attributes);
    check_indices(primitive, mesh, attributes);
  }

 private:
  /// Warns about out-of-range vertex indices: assimp silently drops the faces that use them.
  void check_indices(const Json& primitive, const Json& mesh, const Json& attributes) {
    const std::size_t indices = index_in(primitive, "indices", kNone),
                      position = index_in(attributes, "POSITION", kNone);
    if (indices == kNone || position == kNone) return;
    const std::size_t vertices = data_.values(position).count();
    const std::vector<float> numbers = data_.values(indices).numbers;
    const auto beyond = std::ranges::count_if(
        numbers, [&](float index) { return index >= static_cast<float>(vertices); });
    if (beyond > 0)
      warnings_.push_back(fmt::format(
          "mesh {}: {} of {} indices {} beyond its {} vertices: their faces are left out",
          mesh.value("name", ""), beyond, numbers.size(), beyond == 1 ? "is" : "are", vertices));
  }

  void apply_targets(Json& primitive, Json& mesh, Json& attributes) {
    const std::span<Json> targets = list_of(primitive, "targets"),
                          weights = list_of(mesh, "weights");
    const std::size_t position = index_in(attributes, "POSITION", kNone);
    Values sum;
    for (std::size_t i = 0; i < std::min(targets.size(), weights.size()); ++i) {
      const std::size_t target = index_in(targets[i], "POSITION", kNone);
      if (weights[i] == 0.0 || target == kNone || position == kNone) continue;
      if (sum.numbers.empty()) sum = data_.values(position);
      const Values moved = data_.values(target);
      if (moved.numbers.size() != sum.numbers.size())
        data_.fail(fmt::format("accessors[{}]: a morph target of {} numbers for {}", target,
                               moved.numbers.size(), sum.numbers.size()));
      for (std::size_t k = 0; k < sum.numbers.size(); ++k)
        sum.numbers[k] += weights[i].get<float>() * moved.numbers[k];
    }
    if (!sum.numbers.empty()) attributes["POSITION"] = data_.add(sum);
  }

  /// Makes the set of texture coordinates that the material uses the first set, and applies the
  /// material's placement to it.
  void place_uvs(const Json& primitive, const Json& mesh, Json& attributes) {
    const std::size_t material = index_in(primitive, "material", kNone);
    UvPlacement placement = material < placements_.size() ? placements_[material] : UvPlacement();
    const auto name_of = [](std::size_t set) { return fmt::format("TEXCOORD_{}", set); };
    if (placement.set != 0 && !attributes.contains(name_of(placement.set))) {
      warnings_.push_back(fmt::format(
          "mesh {}: has no texture coordinates {}, which materials[{}] names: {}",
          mesh.value("name", ""), name_of(placement.set), material,
          attributes.contains(name_of(0)) ? "TEXCOORD_0 are used" : "its texture is not shown"));
      placement.set = 0;
    }
    const std::size_t accessor = index_in(attributes, name_of(placement.set).c_str(), kNone);
    if (accessor == kNone) return;
    if (placement != UvPlacement() || !data_.is_plain(accessor))
      attributes["TEXCOORD_0"] = placed(accessor, placement);
  }

  std::size_t placed(std::size_t accessor, const UvPlacement& placement) {
    const auto [place, is_new] = placed_.try_emplace({accessor, placement}, 0);
    if (!is_new) return place->second;
    Values uvs = data_.values(accessor);
    if (uvs.width != 2) data_.fail(fmt::format("accessors[{}]: is not a VEC2", accessor));
    const std::array<float, 6>& rows = placement.rows;
    for (std::size_t i = 0; i < uvs.numbers.size(); i += 2) {
      const float u = uvs.numbers[i], v = uvs.numbers[i + 1];
      uvs.numbers[i] = rows[0] * u + rows[1] * v + rows[2];
      uvs.numbers[i + 1] = rows[3] * u + rows[4] * v + rows[5];
    }
    return place->second = data_.add(uvs);
  }

  /// Keeps only attributes that are used here. Among those that assimp would misread, positions and
  /// colors are converted to floats, and the others are removed.
  void make_floats(Json& attributes) {
    constexpr std::array<std::string_view, 5> kKept = {"COLOR_0", "NORMAL", "POSITION", "TANGENT",
                                                       "TEXCOORD_0"};
    for (auto attribute = attributes.begin(); attribute != attributes.end();) {
      const std::string& name = attribute.key();
      const std::size_t accessor = index_in(attributes, name.c_str(), kNone);
      const bool plain = accessor == kNone || data_.is_plain(accessor);
      const bool seen = name == "COLOR_0" || name == "POSITION";
      if (std::ranges::find(kKept, name) == kKept.end() || (!plain && !seen)) {
        attribute = attributes.erase(attribute);
        continue;
      }
      if (!plain) *attribute = as_floats(accessor, name == "COLOR_0");
      ++attribute;
    }
  }

  std::size_t as_floats(std::size_t accessor, bool shares) {
    const auto [place, is_new] = floats_.try_emplace(accessor, 0);
    if (is_new) place->second = data_.add(data_.values(accessor, shares));
    return place->second;
  }

  Data& data_;
  const std::vector<UvPlacement>& placements_;
  std::vector<std::string>& warnings_;
  std::map<std::pair<std::size_t, UvPlacement>, std::size_t> placed_;
  std::map<std::size_t, std::size_t> floats_;
};

}  // namespace

void repair_primitives(Json& gltf, Data& data, const std::vector<UvPlacement>& placements,
                       std::vector<std::string>& warnings) {
  Repairer repairer(data, placements, warnings);
  for (Json& mesh : list_of(gltf, "meshes"))
    for (Json& primitive : list_of(mesh, "primitives")) repairer.repair(primitive, mesh);
}

}  // namespace mh::gltf
