// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace mh {

/// How the options `-s u v` and `-o u v` of an MTL place a material's texture: texture coordinates
/// are scaled, then moved.
struct MtlUvs {
  Eigen::Vector2f scale = Eigen::Vector2f::Ones(), offset = Eigen::Vector2f::Zero();
  bool operator==(const MtlUvs&) const = default;

  /// @param uv  as in a Scene, whose v grows downward; an OBJ's grows upward
  Eigen::Vector2f place(const Eigen::Vector2f& uv) const {
    return {scale.x() * uv.x() + offset.x(), 1 - (scale.y() * (1 - uv.y()) + offset.y())};
  }
};

/// What MTL files state about textures but assimp does not read.
struct MtlTextures {
  std::map<std::string, MtlUvs> uvs;  ///< by material; only those with such options
  std::vector<std::string> warnings;
};

/// Removes the options of the textures that we show (`map_Kd -s 2 2 1 -bm 1 my image.png`), before
/// or after the name of the file, except -clamp, which assimp reads. nullopt if there are no such
/// options.
/// @param file  names the MTL in warnings about ignored options that would change what is seen
std::optional<std::string> without_options(std::string_view mtl, const std::filesystem::path& file,
                                           MtlTextures& textures);

}  // namespace mh
