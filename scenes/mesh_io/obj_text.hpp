// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mh {

/// An OBJ or its materials (MTL) as assimp can read them; nullopt: as they are. Coordinates may
/// begin with their point (`v .5 -.5 0`); `aniso` and `anisor` of MTL's extension for physically
/// based materials, which no picture of ours shows, are left out.
std::optional<std::string> repaired_obj(std::string_view text);

}  // namespace mh
