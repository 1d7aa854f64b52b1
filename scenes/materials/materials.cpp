// SPDX-License-Identifier: Apache-2.0
#include "scenes/materials/materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/materials/painters.hpp"
#include "scenes/name_key.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr float kWhole = 0.0F;  // marks an image: the tile is MaterialSpec::size_m

struct Kind {
  std::string_view name;
  float tile_u_m, tile_v_m;  ///< size of one repeat, kWhole for images
  float texel_m;
  Painter paint;
};

constexpr std::array kMaterialKinds = {
    Kind{"bark", 0.5F, 0.5F, 0.002F, paint_bark},
    Kind{"book_covers", kWhole, kWhole, 0.001F, paint_book_cover},
    Kind{"book_spines", kWhole, kWhole, 0.001F, paint_book_spines},
    Kind{"brushed_metal", 1.0F, 1.0F, 0.002F, paint_brushed_metal},
    Kind{"carpet", 1.2F, 1.2F, 0.0025F, paint_carpet},
    Kind{"ceiling_paint", 2.0F, 2.0F, 0.004F, paint_ceiling},
    Kind{"ceramic", 1.0F, 1.0F, 0.004F, paint_smooth},
    Kind{"curtain_fabric", 0.8F, 0.8F, 0.002F, paint_curtain},
    Kind{"fabric", 0.6F, 0.6F, 0.0015F, paint_fabric},
    Kind{"foliage", kWhole, kWhole, 0.001F, paint_leaf},
    Kind{"garden_view", kWhole, kWhole, 0.003F, paint_garden},
    Kind{"glass", 1.0F, 1.0F, 0.004F, paint_smooth},
    Kind{"knit", 0.5F, 0.5F, 0.0015F, paint_knit},
    Kind{"leather", 0.8F, 0.8F, 0.002F, paint_leather},
    Kind{"painting", kWhole, kWhole, 0.002F, paint_painting},
    Kind{"paper", kWhole, kWhole, 0.001F, paint_paper},
    Kind{"parquet", 2.1F, 2.1F, 0.0025F, paint_parquet},
    Kind{"plaster", 2.4F, 2.4F, 0.004F, paint_plaster},
    Kind{"plastic", 1.0F, 1.0F, 0.004F, paint_smooth},
    Kind{"poster", kWhole, kWhole, 0.001F, paint_poster},
    Kind{"rug_pattern", kWhole, kWhole, 0.0025F, paint_rug},
    Kind{"screen", kWhole, kWhole, 0.0015F, paint_screen},
    Kind{"stone", 1.2F, 1.2F, 0.002F, paint_stone},
    Kind{"tiles", 1.2F, 1.2F, 0.002F, paint_tiles},
    Kind{"whiteboard", kWhole, kWhole, 0.002F, paint_whiteboard},
    Kind{"wood_boards", 2.4F, 1.2F, 0.0025F, paint_wood_boards},
    Kind{"wood_grain", 2.0F, 0.8F, 0.002F, paint_wood_grain},
};

constexpr auto kMaterialNames = [] {
  std::array<std::string_view, kMaterialKinds.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kMaterialKinds[i].name;
  return names;
}();

constexpr int kMaxTexels = 1024;

const Kind& find_kind(std::string_view name) {
  const auto* const found = std::ranges::find(kMaterialKinds, name, &Kind::name);
  if (found == kMaterialKinds.end())
    throw InputError(fmt::format("unknown kind of material: {}", name));
  return *found;
}

}  // namespace

void validate(const MaterialSpec& spec) {
  find_kind(spec.kind);
  if (!(spec.variation >= 0.0 && spec.variation <= 1.0))
    throw InputError(
        fmt::format("material {}: variation must lie in [0, 1], is {}", spec.name, spec.variation));
  if (!(spec.size_m.minCoeff() > 0.0F) || !spec.size_m.allFinite())
    throw InputError(fmt::format("material {}: size_m must be positive, is {} x {}", spec.name,
                                 spec.size_m.x(), spec.size_m.y()));
}

Material make_material(const MaterialSpec& spec) {
  validate(spec);
  const Kind& kind = find_kind(spec.kind);
  Material material;
  material.name = spec.name.empty() ? spec.kind : spec.name;
  material.tile_m =
      is_image(spec.kind) ? spec.size_m : Eigen::Vector2f(kind.tile_u_m, kind.tile_v_m);
  // Long images get coarser texels instead of being cropped.
  const float texel_m = std::max(kind.texel_m, material.tile_m.maxCoeff() / kMaxTexels);
  const auto texels = [&](float length_m) {
    return std::max(8, static_cast<int>(std::lround(length_m / texel_m)));
  };
  material.texture = kind.paint({.width = texels(material.tile_m.x()),
                                 .height = texels(material.tile_m.y()),
                                 .texel_m = texel_m,
                                 .tone = Tint(spec.tone),
                                 .variation = static_cast<float>(spec.variation),
                                 // Two kinds with the same seed do not share a random stream.
                                 .random = RandomStream(spec.seed).fork(name_key(spec.kind))});
  return material;
}

std::span<const std::string_view> material_kinds() {
  return kMaterialNames;
}

bool is_image(std::string_view kind) {
  return find_kind(kind).tile_u_m == kWhole;
}

}  // namespace mh
