// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "scenes/scene.hpp"

namespace mh {

/// Specification of a surface; it determines the texture, bit for bit.
struct MaterialSpec {
  std::string name;                    ///< name of the result; empty = the kind
  std::string kind;                    ///< one of material_kinds()
  Rgb8 tone{180, 140, 100};            ///< sRGB, the surface's mean color (images: their key color)
  double variation = 0.5;              ///< contrast of the pattern, 0 (faint) to 1 (strong)
  std::uint64_t seed = 0;              ///< different seeds give different samples of a material
  Eigen::Vector2f size_m{1.0F, 1.0F};  ///< size of the whole image if is_image(kind)
};

/// @throws InputError if the kind is unknown, or a number out of range.
void validate(const MaterialSpec& spec);

/// Generates a procedural surface at 1 to 4 mm per texel, at most 1024 x 1024. Repeating materials
/// tile without a seam and choose their own Material::tile_m; images (posters, rows of books,
/// screens, views) cover spec.size_m once. Wood grain runs along u.
/// @throws InputError on an unknown kind, a variation outside [0, 1] or a size that is not
/// positive.
Material make_material(const MaterialSpec& spec);

/// Every kind, in alphabetical order.
std::span<const std::string_view> material_kinds();

/// Whether a kind fills spec.size_m once instead of repeating. @throws InputError if unknown.
bool is_image(std::string_view kind);

}  // namespace mh
