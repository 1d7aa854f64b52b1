// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mh {

/// Rewrites an OBJ or its materials (MTL) so that assimp can read them; nullopt if no change is
/// needed. Coordinates may start with the decimal point (`v .5 -.5 0`); `aniso` and `anisor` of
/// MTL's extension for physically based materials, which we do not render, are removed. Faces
/// before the first usemtl get a material of their own: assimp would give them the last material of
/// the library.
std::optional<std::string> repaired_obj(std::string_view text);

}  // namespace mh
